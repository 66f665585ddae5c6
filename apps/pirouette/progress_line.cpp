#include "progress_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace pirouette::app {
namespace {

constexpr std::size_t kBarWidth = 20;
constexpr int kLineStep = 10;  // %, between lines that are not redrawn
constexpr int kWhole = 100;    // %
constexpr std::chrono::milliseconds kRedrawPeriod{50};

std::string bar(double share) {
  std::string cells(kBarWidth, '-');
  std::fill_n(cells.begin(), static_cast<std::size_t>(share * kBarWidth), '#');
  return cells;
}

}  // namespace

ProgressLine::ProgressLine() : terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (terminal_ && drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressLine::update(double share, const std::string& text) {
  share = std::clamp(share, 0.0, 1.0);
  const int percent = static_cast<int>(kWhole * share);
  const auto now = std::chrono::steady_clock::now();
  const bool too_early = terminal_ ? drawn_ && percent < kWhole && now - last_draw_ < kRedrawPeriod
                                   : percent < next_percent_;
  if (too_early) return;
  next_percent_ = percent - percent % kLineStep + kLineStep;
  last_draw_ = now;
  drawn_ = true;
  if (terminal_) {
    std::fprintf(stderr, "\r[%s] %s\x1b[K", bar(share).c_str(), text.c_str());
  } else {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
  std::fflush(stderr);
}

}  // namespace pirouette::app
