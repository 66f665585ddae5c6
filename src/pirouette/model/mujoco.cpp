#include "pirouette/model/mujoco.hpp"

#include <mutex>

namespace pirouette {
namespace {

thread_local MujocoWarnings* innermost = nullptr;

[[noreturn]] void throw_error(const char* text) {
  throw MujocoError(std::string("MuJoCo: ") + text);
}

}  // namespace

void remember_mujoco_warning(const char* text) {
  if (innermost != nullptr) innermost->texts_.emplace_back(text);
}

void catch_mujoco_errors() {
  static std::once_flag once;
  std::call_once(once, [] {
    mju_user_error = throw_error;
    mju_user_warning = remember_mujoco_warning;
  });
}

MujocoWarnings::MujocoWarnings() : outer_(innermost) { innermost = this; }
MujocoWarnings::~MujocoWarnings() { innermost = outer_; }

}  // namespace pirouette
