// How far a run or a sweep is, on stderr.
#pragma once

#include <chrono>
#include <string>

namespace pirouette::app {

/// On a terminal one line with a bar, redrawn; otherwise a line for each tenth.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();  ///< takes the line off the terminal
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Shows `text` unless the last one was shown just before. `share`: what is done, 0 to 1.
  void update(double share, const std::string& text);

 private:
  bool terminal_;
  bool drawn_ = false;
  int next_percent_ = 0;
  std::chrono::steady_clock::time_point last_draw_;
};

}  // namespace pirouette::app
