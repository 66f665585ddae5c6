// MuJoCo's objects with an owner, and its errors as exceptions.
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace pirouette {

/// Deleter of MuJoCo's objects.
struct MujocoDeleter {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using SpecPtr = std::unique_ptr<mjSpec, MujocoDeleter>;
using ModelPtr = std::unique_ptr<mjModel, MujocoDeleter>;
using DataPtr = std::unique_ptr<mjData, MujocoDeleter>;

/// A fatal error of MuJoCo, which would otherwise end the process.
class MujocoError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// From the first call on, a fatal error of MuJoCo throws MujocoError where it was called, and
/// neither errors nor warnings are written to MUJOCO_LOG.TXT. Any thread, any number of calls.
void catch_mujoco_errors();

/// Collects the warnings that MuJoCo gives on this thread while it lives.
class MujocoWarnings {
 public:
  MujocoWarnings();
  ~MujocoWarnings();
  MujocoWarnings(const MujocoWarnings&) = delete;
  MujocoWarnings& operator=(const MujocoWarnings&) = delete;

  const std::vector<std::string>& texts() const { return texts_; }

 private:
  friend void remember_mujoco_warning(const char* text);
  std::vector<std::string> texts_;
  MujocoWarnings* outer_;
};

}  // namespace pirouette
