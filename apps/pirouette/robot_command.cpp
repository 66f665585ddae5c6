#include "robot_command.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <iostream>

#include "become_python.hpp"
#include "exit_code.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/robot_file.hpp"
#include "pirouette/study/robot_check.hpp"

namespace pirouette::app {
namespace {

constexpr int kNoProgram = 127;  ///< exit code of a child that could not become another program

}  // namespace

RobotCommand::RobotCommand(CLI::App& app) {
  command_ = app.add_subcommand("robot", "Look a robot's file over before it walks");
  command_->require_subcommand(0, 1);
  const std::string what = "Name of a robot, or an MJCF (.xml), URDF (.urdf) or robot.toml file";
  check_ = command_->add_subcommand(
      "check", "Say what was found, mended and assumed, and whether the robot can walk");
  check_->add_option("ROBOT", robot_, what)->required();
  check_->add_flag("--json", json_, "Print it as JSON");
  check_->add_option("--picture", picture_,
                     "Draw the standing robot with its joints and feet named into this PNG, PDF or "
                     "SVG file (needs the Python package)");
  describe_ = command_->add_subcommand("describe", "Print a robot.toml with everything found");
  describe_->add_option("ROBOT", robot_, what)->required();
  list_ = command_->add_subcommand("list", "List the robots in the box");
}

int RobotCommand::check() const {
  const Result<RobotCheck> check = check_robot(robot_);
  if (!check) return report(check.errors());
  std::cout << (json_ ? robot_check_json(check.value()) : robot_check_text(check.value()));
  std::cout.flush();
  const int drawn = picture_.empty() ? kDone : draw();
  return check.value().problems.empty() ? drawn : report(check.value().problems);
}

int RobotCommand::draw() const {
  const pid_t child = ::fork();
  if (child == 0) {
    std::string program = "pirouette-robot-picture", robot = robot_, picture = picture_;
    std::array<char*, 4> line = {program.data(), robot.data(), picture.data(), nullptr};
    become_python("robot_picture", line.data());
    ::_exit(kNoProgram);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) return kBadUsage;
  if (WEXITSTATUS(status) != kNoProgram) return WEXITSTATUS(status);
  return report({{"--picture", 0, "",
                  "no program pirouette-robot-picture on PATH; it comes with the Python package: "
                  "run `make python` or `pip install .` in the source tree"}});
}

int RobotCommand::describe() const {
  const Result<RobotCheck> check = check_robot(robot_);
  if (!check) return report(check.errors());
  std::cout << robot_toml(check.value().description);
  return kDone;
}

int RobotCommand::list() const {
  for (const std::string& name : known_robots()) {
    const Result<RobotCheck> check = check_robot(name);
    if (!check) return report(check.errors());
    const RobotCheck& robot = check.value();
    std::cout.precision(3);
    std::cout << name << std::string(name.size() < 16 ? 16 - name.size() : 1, ' ') << robot.mass
              << " kg, CoM " << robot.height << " m high\n";
  }
  return kDone;
}

int RobotCommand::run() const {
  if (check_->parsed()) return check();
  if (describe_->parsed()) return describe();
  if (list_->parsed()) return list();
  return report({{"robot", 0, "", "needs one of check, describe, list"}});
}

}  // namespace pirouette::app
