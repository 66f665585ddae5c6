#include "progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace pirouette::app {
namespace {

constexpr std::size_t kBarWidth = 20;
constexpr int kLineStep = 10;  // %, between lines that are not redrawn
constexpr std::chrono::milliseconds kRedrawPeriod{50};

std::string bar(double share) {
  std::string cells(kBarWidth, '-');
  const auto filled = static_cast<std::size_t>(share * kBarWidth);
  std::fill_n(cells.begin(), filled, '#');
  return cells;
}

}  // namespace

ProgressBar::ProgressBar(bool about_a_point)
    : about_a_point_(about_a_point), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (terminal_ && drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::update(const TrialProgress& p) {
  const double share = p.duration > 0.0 ? p.time / p.duration : 1.0;
  const int percent = static_cast<int>(100.0 * share);
  const auto now = std::chrono::steady_clock::now();
  if (terminal_ ? drawn_ && percent < 100 && now - last_draw_ < kRedrawPeriod
                : percent < next_percent_) {
    return;
  }
  next_percent_ = percent - percent % kLineStep + kLineStep;
  last_draw_ = now;
  drawn_ = true;

  char text[128];
  std::snprintf(text, sizeof text, "%3d %%  %5.1f s  %5.1f x real time  %6.2f turns", percent,
                p.time, p.real_time_factor, p.turns);
  std::string line = text;
  if (about_a_point_) {
    std::snprintf(text, sizeof text, "  %5.1f mm off", p.distance_to_point * 1e3);
    line += text;
  }
  if (terminal_) {
    std::fprintf(stderr, "\r[%s] %s\x1b[K", bar(share).c_str(), line.c_str());
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
  std::fflush(stderr);
}

}  // namespace pirouette::app
