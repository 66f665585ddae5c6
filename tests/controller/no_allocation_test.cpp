// Counts what tick() takes from the heap by standing between the process and glibc's allocator. A
// program of its own, because the replacement is process-wide; off under sanitizers, which bring
// their own.
#include <execinfo.h>
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <tuple>
#include <vector>

#include "support/closed_loop.hpp"

namespace {

bool counting = false;  // this program has one thread
long allocations = 0;
std::array<void*, 32> first_place;  // call stack of the first one
int first_depth = 0;

void count() {
  if (!counting) return;
  if (allocations++ == 0) {
    counting = false;  // backtrace() may allocate
    first_depth = backtrace(first_place.data(), static_cast<int>(first_place.size()));
    counting = true;
  }
}

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) noexcept {
  count();
  return __libc_malloc(size);
}
void* calloc(std::size_t number, std::size_t size) noexcept {
  count();
  return __libc_calloc(number, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  count();
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  count();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  count();
  *block = __libc_memalign(alignment, size);
  return *block ? 0 : ENOMEM;
}
}

namespace pirouette {
namespace {

using test::ClosedLoop;
using test::spin;
using test::stand_still;

/// Allocations while `work` runs.
template <class Work>
long allocations_of(const Work& work) {
  allocations = 0;
  counting = true;
  work();
  counting = false;
  return allocations;
}

/// Makes the compiler believe that `block` is used, so that it cannot leave the allocation out.
void use(const void* block) { asm volatile("" : : "r"(block) : "memory"); }

void release(void* block) {
  use(block);
  free(block);
}

TEST(NoAllocation, GuardSeesEveryWayToAllocate) {
  EXPECT_EQ(allocations_of([] { release(malloc(10)); }), 1);
  EXPECT_EQ(allocations_of([] { release(calloc(3, 10)); }), 1);
  EXPECT_EQ(allocations_of([] { release(realloc(nullptr, 10)); }), 1);
  EXPECT_EQ(allocations_of([] { release(memalign(64, 64)); }), 1);
  EXPECT_EQ(allocations_of([] { release(aligned_alloc(64, 64)); }), 1);
  EXPECT_EQ(allocations_of([] {
              void* block = nullptr;
              if (posix_memalign(&block, 64, 64) == 0) release(block);
            }),
            1);
  EXPECT_EQ(allocations_of([] { use(std::vector<double>(100).data()); }), 1);
  EXPECT_EQ(allocations_of([] { use(Eigen::MatrixXd(20, 20).data()); }), 1);
  EXPECT_EQ(allocations_of([] {}), 0);
}

using Modes = std::tuple<FootModel, ComPlanner, PathReferenceMode, PathTracker>;

class EveryMode : public testing::TestWithParam<Modes> {};

TEST_P(EveryMode, TickTakesNothingFromTheHeap) {
  Config config;
  std::tie(config.foot.model, config.com.planner, config.path.reference, config.path.tracker) =
      GetParam();
  ClosedLoop loop(config);
  int constrained = 0;
  // Stands, is pushed, spins, is pushed again, bridges bad readings, stops.
  for (int i = 0; i < 2200; ++i) {
    if (i == 50 || i == 1000) loop.plant.push(Vec3(0.3, 0.4, 0.0));
    SensorReading sensors = loop.plant.sense();
    if (i >= 1500 && i < 1505) sensors.time = std::nan("");
    const MotionCommand motion = i < 200 || i > 2000 ? stand_still() : spin(0.7);
    if (allocations_of([&] { loop.controller.tick(sensors, motion); }) > 0) {
      backtrace_symbols_fd(first_place.data(), first_depth, STDERR_FILENO);
      FAIL() << "allocates in tick " << i;
    }
    constrained += loop.controller.trace().mpc.status == SolveStatus::kConstrained;
    loop.plant.advance(loop.controller.trace().command);
  }
  EXPECT_GT(constrained, 0);  // the pushes did put the active-set solver to work
  EXPECT_FALSE(is_stood_down(loop.controller.status()));
}

std::string mode_name(const testing::TestParamInfo<Modes>& mode) {
  const auto name = [](auto value) {
    return std::string(EnumNames<decltype(value)>::kNames.at(static_cast<std::size_t>(value)));
  };
  const auto& [foot, planner, reference, tracker] = mode.param;
  return name(foot) + "_" + name(planner) + "_" + name(reference) + "_" + name(tracker);
}

INSTANTIATE_TEST_SUITE_P(
    NoAllocation, EveryMode,
    testing::Combine(testing::Values(FootModel::kCentre, FootModel::kRolling),
                     testing::Values(ComPlanner::kLinear, ComPlanner::kPsp),
                     testing::Values(PathReferenceMode::kVelocity, PathReferenceMode::kIntegrated,
                                     PathReferenceMode::kAnchored),
                     testing::Values(PathTracker::kNone, PathTracker::kLqr, PathTracker::kLqi)),
    mode_name);

TEST(NoAllocation, StandingDownTakesNothingFromTheHeapEither) {
  Config config;
  config.safety.self_check = SelfCheckMode::kNone;
  config.joint.kp_stance = std::nan("");
  ClosedLoop loop(config);
  const SensorReading sensors = loop.plant.sense();
  EXPECT_EQ(allocations_of([&] { loop.controller.tick(sensors, stand_still()); }), 0);
  EXPECT_TRUE(is_stood_down(loop.controller.status()));
}

}  // namespace
}  // namespace pirouette
