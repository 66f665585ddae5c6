// What the program's exit code says, and how it says what was wrong.
#pragma once

#include "pirouette/base/result.hpp"

namespace pirouette::app {

enum ExitCode : int {
  kDone = 0,
  kFell = 1,      ///< the robot fell
  kNotDone = 1,   ///< less was done than asked for; a bound was missed; a replay differs
  kBadUsage = 2,  ///< command line, configuration, files
  kSignal = 128,  ///< plus the signal's number: 130 after Ctrl-C
};

/// One line "error: ..." each on stderr; returns kBadUsage.
int report(const Errors& errors);

}  // namespace pirouette::app
