#include "robot_command.hpp"

#include <iostream>

#include "exit_code.hpp"
#include "pirouette/config/data_folders.hpp"
#include "pirouette/config/robot_file.hpp"
#include "pirouette/study/robot_check.hpp"

namespace pirouette::app {

RobotCommand::RobotCommand(CLI::App& app) {
  command_ = app.add_subcommand("robot", "Look a robot's file over before it walks");
  command_->require_subcommand(0, 1);
  const std::string what = "Name of a robot, or an MJCF (.xml), URDF (.urdf) or robot.toml file";
  check_ = command_->add_subcommand(
      "check", "Say what was found, mended and assumed, and whether the robot can walk");
  check_->add_option("ROBOT", robot_, what)->required();
  check_->add_flag("--json", json_, "Print it as JSON");
  describe_ = command_->add_subcommand("describe", "Print a robot.toml with everything found");
  describe_->add_option("ROBOT", robot_, what)->required();
  list_ = command_->add_subcommand("list", "List the robots in the box");
  command_->footer(
      "pirouette robot-picture ROBOT FILE.png draws the robot with its joints (needs the Python "
      "package).");
}

int RobotCommand::check() const {
  const Result<RobotCheck> check = check_robot(robot_);
  if (!check) return report(check.errors());
  std::cout << (json_ ? robot_check_json(check.value()) : robot_check_text(check.value()));
  return check.value().problems.empty() ? kDone : report(check.value().problems);
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
