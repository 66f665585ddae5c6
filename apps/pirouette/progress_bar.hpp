// How far a run is, on stderr.
#pragma once

#include <chrono>

#include "pirouette/trial/trial.hpp"

namespace pirouette::app {

/// On a terminal one line, redrawn; otherwise a line every 10 %.
class ProgressBar {
 public:
  /// `about_a_point`: the distance to the point means something.
  explicit ProgressBar(bool about_a_point);
  ~ProgressBar();  ///< ends the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void update(const TrialProgress& progress);

 private:
  bool about_a_point_;
  bool terminal_;
  bool drawn_ = false;
  int next_percent_ = 0;
  std::chrono::steady_clock::time_point last_draw_;
};

}  // namespace pirouette::app
