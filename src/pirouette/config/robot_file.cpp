#include "pirouette/config/robot_file.hpp"

#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <vector>

#include "pirouette/base/fields.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/suggest.hpp"
#include "pirouette/config/toml_node.hpp"

namespace pirouette {
namespace {

namespace fs = std::filesystem;

constexpr Range kAngle{-100.0, 100.0};   // rad
constexpr Range kFootRadius{1e-3, 0.5};  // m
constexpr Range kTorque{1e-3, 1e5};      // N m
constexpr Range kArmature{0.0, 100.0};   // kg m^2

std::string ending(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// The SRDF file of a URDF: the one of its name, else the only one there.
std::optional<fs::path> find_srdf(const fs::path& urdf) {
  const fs::path here = urdf.parent_path();
  for (const fs::path& folder : {here, here / ".." / "srdf"}) {
    std::vector<fs::path> files;
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, none)) {
      if (ending(entry.path()) != ".srdf") continue;
      if (entry.path().stem() == urdf.stem()) return entry.path();
      files.push_back(entry.path());
    }
    if (files.size() == 1) return files.front();
  }
  return std::nullopt;
}

/// Adds the first pose of an SRDF file; a file without one adds nothing.
void read_srdf(const fs::path& file, RobotDescription& robot) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(file.c_str()) != tinyxml2::XML_SUCCESS) return;
  const tinyxml2::XMLElement* root = document.FirstChildElement("robot");
  const tinyxml2::XMLElement* state = root ? root->FirstChildElement("group_state") : nullptr;
  if (state == nullptr) return;
  for (const auto* joint = state->FirstChildElement("joint"); joint;
       joint = joint->NextSiblingElement("joint")) {
    const char* name = joint->Attribute("name");
    const char* value = joint->Attribute("value");
    // A floating base has seven numbers.
    if (!name || !value || std::string(value).find(' ') != std::string::npos) continue;
    double angle = 0.0;
    if (joint->QueryDoubleAttribute("value", &angle) == tinyxml2::XML_SUCCESS)
      robot.pose[name] = angle;
  }
}

std::optional<double> number(const toml::node& node, Range range) {
  const std::optional<double> value = node.value<double>();
  const bool good = !node.is_boolean() && value && std::isfinite(*value) && range.min <= *value &&
                    *value <= range.max;
  return good ? value : std::nullopt;
}

class RobotReader {
 public:
  explicit RobotReader(const fs::path& file) : path_(file) { robot_.source = file.string(); }

  Result<RobotDescription> read(const toml::table& table) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      if (name == "file") {
        if (check(node, name, node.is_string(), "the path of an MJCF or URDF file"))
          read_file(node);
      } else if (name == "imu") {
        if (check(node, name, node.is_string(), "the name of a site"))
          robot_.imu = node.as_string()->get();
      } else if (name == "legs") {
        if (check(node, name, node.is_table(), "the tables FR, FL, RR, RL"))
          read_legs(*node.as_table());
      } else if (name == "locked") {
        if (check(node, name, node.is_table(), "a table: joint = rad or m"))
          read_locked(*node.as_table());
      } else {
        report_unknown(node, name, {"file", "imu", "legs", "locked"});
      }
    }
    if (table.get("file") == nullptr)
      errors_.push_back({robot_.source, 0, "file", "missing; the MJCF or URDF file of the robot"});
    std::stable_sort(errors_.begin(), errors_.end(),
                     [](const Error& a, const Error& b) { return a.line < b.line; });
    if (!errors_.empty()) return errors_;
    return robot_;
  }

 private:
  bool check(const toml::node& node, const std::string& key, bool good,
             const std::string& allowed) {
    if (!good) report(node, key, "given " + shown(node) + "; allowed: " + allowed);
    return good;
  }

  void report(const toml::node& node, const std::string& key, std::string message) {
    errors_.push_back(
        {robot_.source, static_cast<int>(node.source().begin.line), key, std::move(message)});
  }

  void report_unknown(const toml::node& node, const std::string& key,
                      const std::vector<std::string>& names) {
    const std::optional<std::string> meant = nearest(key.substr(key.rfind('.') + 1), names);
    report(node, key,
           "unknown key; " +
               (meant ? "did you mean " + *meant + "?" : "allowed here: " + joined(names)));
  }

  void read_file(const toml::node& node) {
    const fs::path file = path_.parent_path() / fs::path(node.as_string()->get());
    const bool is_model = ending(file) == ".xml" || ending(file) == ".urdf";
    if (!check(node, "file", is_model, "an MJCF file ending in .xml or a URDF file in .urdf"))
      return;
    if (!fs::is_regular_file(file)) {
      report(node, "file", "given " + shown(node) + ": no such file");
      return;
    }
    robot_.file = file.string();
    if (const auto srdf = ending(file) == ".urdf" ? find_srdf(file) : std::nullopt)
      read_srdf(*srdf, robot_);
  }

  void read_locked(const toml::table& table) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      const std::optional<double> value = number(node, kAngle);
      if (check(node, "locked." + name, value.has_value(), "-100 to 100 rad (of a slide: m)"))
        robot_.locked[name] = *value;
    }
  }

  void read_legs(const toml::table& table) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      const auto found = std::find(kLegNames.begin(), kLegNames.end(), name);
      if (found == kLegNames.end()) {
        report_unknown(node, "legs." + name, {"FR", "FL", "RR", "RL"});
      } else if (check(node, "legs." + name, node.is_table(), "a table")) {
        const Leg leg = kLegs.at(static_cast<std::size_t>(found - kLegNames.begin()));
        read_leg(*node.as_table(), "legs." + name + ".", robot_.legs[leg]);
      }
    }
    const auto names_joints = [&](Leg leg) { return !robot_.legs[leg].joints[0].empty(); };
    const auto count = std::count_if(kLegs.begin(), kLegs.end(), names_joints);
    if (count != 0 && count != static_cast<std::ptrdiff_t>(kLegCount))
      report(table, "legs",
             "joints are named of " + std::to_string(count) +
                 " legs; allowed: of all four, or of none");
  }

  void read_leg(const toml::table& table, const std::string& prefix, LegDescription& leg) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str()), at = prefix + name;
      if (name == "joints") {
        check(node, at, read_names(node, leg.joints), "three names: abad, hip, knee");
      } else if (name == "sign") {
        read_vector(node, at, {-1.0, 1.0}, "three of 1 and -1: abad, hip, knee", leg.sign);
        if (leg.sign && (leg.sign->array().abs() != 1.0).any())
          check(node, at, false, "three of 1 and -1: abad, hip, knee");
      } else if (name == "zero") {
        read_vector(node, at, kAngle, "three angles: abad, hip, knee, each -100 to 100 rad",
                    leg.zero);
      } else if (name == "torque") {
        read_vector(node, at, kTorque, "three limits: abad, hip, knee, each 0.001 to 1e5 N m",
                    leg.torque);
      } else if (name == "armature") {
        read_vector(node, at, kArmature, "three inertias: abad, hip, knee, each 0 to 100 kg m^2",
                    leg.armature);
      } else if (name == "knee") {
        const auto* word = node.as_string();
        const bool good = word && (word->get() == "backward" || word->get() == "forward");
        if (check(node, at, good, "\"backward\", \"forward\""))
          leg.knee_sign = word->get() == "forward" ? 1.0 : -1.0;
      } else if (name == "foot") {
        if (check(node, at, node.is_string(), "the name of a geom, body or site"))
          leg.foot = node.as_string()->get();
      } else if (name == "foot_radius") {
        leg.foot_radius = number(node, kFootRadius);
        check(node, at, leg.foot_radius.has_value(), "0.001 to 0.5 m");
      } else {
        report_unknown(
            node, at,
            {"joints", "sign", "zero", "knee", "foot", "foot_radius", "torque", "armature"});
      }
    }
  }

  static bool read_names(const toml::node& node, std::array<std::string, kJointsPerLeg>& out) {
    const toml::array* list = node.as_array();
    if (list == nullptr || list->size() != kJointsPerLeg) return false;
    for (std::size_t i = 0; i < kJointsPerLeg; ++i) {
      if (!(*list)[i].is_string() || (*list)[i].as_string()->get().empty()) return false;
      out[i] = (*list)[i].as_string()->get();
    }
    return true;
  }

  void read_vector(const toml::node& node, const std::string& key, Range range,
                   const std::string& allowed, std::optional<Vec3>& out) {
    const toml::array* list = node.as_array();
    Vec3 values;
    bool good = list != nullptr && list->size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) {
      const std::optional<double> value = number((*list)[i], range);
      good = value.has_value();
      if (good) values[static_cast<Eigen::Index>(i)] = *value;
    }
    if (check(node, key, good, allowed)) out = values;
  }

  fs::path path_;
  RobotDescription robot_;
  Errors errors_;
};

std::string list(const Vec3& values) {
  return "[" + toml_literal(values[0]) + ", " + toml_literal(values[1]) + ", " +
         toml_literal(values[2]) + "]";
}

}  // namespace

bool is_robot_file(const fs::path& path) {
  const std::string text = ending(path);
  return text == ".xml" || text == ".urdf" || text == ".toml";
}

Result<RobotDescription> load_robot_file(const fs::path& path) {
  if (!fs::is_regular_file(path)) return Error{path.string(), 0, "", "no such file"};
  if (ending(path) != ".toml") {
    RobotDescription robot(path.string());
    if (const auto srdf = ending(path) == ".urdf" ? find_srdf(path) : std::nullopt)
      read_srdf(*srdf, robot);
    return robot;
  }
  Errors errors;
  const std::optional<toml::table> table = parse_toml_file(path, errors);
  if (!table) return errors;
  return RobotReader(path).read(*table);
}

std::string robot_toml(const RobotDescription& robot) {
  const auto quoted = [](const std::string& text) { return toml_literal(text); };
  std::string text =
      "# What pirouette found in the file. Lines may be changed; what is left out is found "
      "again.\n";
  text += "file = " + quoted(fs::absolute(robot.file).string()) + "\n";
  if (!robot.imu.empty()) text += "imu = " + quoted(robot.imu) + "  # site of the IMU\n";
  for (const Leg leg : kLegs) {
    const LegDescription& l = robot.legs[leg];
    text += "\n[legs." + std::string(name(leg)) + "]  # abad, hip, knee\n";
    if (!l.joints[0].empty()) {
      text += "joints = [" + quoted(l.joints[0]) + ", " + quoted(l.joints[1]) + ", " +
              quoted(l.joints[2]) + "]\n";
    }
    if (l.sign) text += "sign = " + list(*l.sign) + "  # -1: the joint turns about -x or -y\n";
    if (l.zero) text += "zero = " + list(*l.zero) + "  # rad, where the leg hangs straight down\n";
    if (l.knee_sign)
      text += std::string("knee = ") + (*l.knee_sign < 0.0 ? "\"backward\"" : "\"forward\"") + "\n";
    if (!l.foot.empty()) text += "foot = " + quoted(l.foot) + "  # geom, body or site\n";
    if (l.foot_radius) text += "foot_radius = " + toml_literal(*l.foot_radius) + "  # m\n";
    if (l.torque) text += "torque = " + list(*l.torque) + "  # N m\n";
    if (l.armature) text += "armature = " + list(*l.armature) + "  # kg m^2\n";
  }
  if (!robot.locked.empty()) text += "\n[locked]  # rad\n";
  for (const auto& [joint, value] : robot.locked)
    text += quoted(joint) + " = " + toml_literal(value) + "\n";
  return text;
}

}  // namespace pirouette
