#include "realtime.hpp"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace pirouette::app {
namespace {

constexpr int kPriority = 80;  // of 1 to 99: above the kernel's interrupt threads, which have 50
constexpr double kNanosecond = 1e-9;

double now() {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + kNanosecond * static_cast<double>(time.tv_nsec);
}

void sleep_until(double time) {
  const double whole = std::floor(time);
  const timespec due{
      static_cast<time_t>(whole),
      static_cast<long>((time - whole) / kNanosecond)};  // NOLINT(google-runtime-int)
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
  }
}

std::string refusal(const char* what) { return std::string(what) + ": " + std::strerror(errno); }

}  // namespace

std::vector<std::string> request_real_time() {
  std::vector<std::string> refused;
  const sched_param priority{.sched_priority = kPriority};
  if (::sched_setscheduler(0, SCHED_FIFO, &priority) != 0) refused.push_back(refusal("SCHED_FIFO"));
  // Where the amount is limited, locking what is to come would make later allocations fail.
  rlimit limit{};
  const bool unlimited =
      ::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  if (::mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) != 0) {
    refused.push_back(refusal("mlockall"));
  }
  return refused;
}

void RealTimePacer::wait(std::int64_t tick) {
  if (ticks_++ == 0) {
    start_ = now() - period_ * static_cast<double>(tick);
    return;
  }
  const double due = start_ + period_ * static_cast<double>(tick);
  const double late = now() - due;
  if (late > 0.0) {
    ++missed_;
    worst_miss_ = std::max(worst_miss_, late);
    return;
  }
  sleep_until(due);
  latest_wake_up_ = std::max(latest_wake_up_, now() - due);
}

std::string RealTimePacer::summary(const std::vector<std::string>& refused) const {
  char text[256];
  std::snprintf(text, sizeof text,
                "Real time: %lld of %lld deadlines missed, the worst by %.3f ms; latest wake-up "
                "%.0f us",
                static_cast<long long>(missed_), static_cast<long long>(ticks_), worst_miss_ * 1e3,
                latest_wake_up_ * 1e6);
  std::string line = std::string(text) + "\nReal time: ";
  if (refused.empty()) return line + "SCHED_FIFO and mlockall granted";
  line += "without ";
  for (std::size_t i = 0; i < refused.size(); ++i) line += (i > 0 ? ", " : "") + refused[i];
  return line;
}

}  // namespace pirouette::app
