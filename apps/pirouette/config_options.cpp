#include "config_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string_view>
#include <system_error>

#include "pirouette/base/math.hpp"
#include "pirouette/config/toml.hpp"

namespace pirouette::app {
namespace {

std::string quoted(const std::string& text) { return '"' + text + '"'; }

/// Shortest text that reads back as the same number; TOML takes it.
std::string as_toml(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

/// "0.1,-0.2" as "[0.1, -0.2]"; absent when it is not two finite numbers.
std::optional<std::string> pair_as_toml(const std::string& text) {
  const char* next = text.c_str();
  std::string list;
  for (const char terminator : {',', '\0'}) {
    char* end = nullptr;
    const double number = std::strtod(next, &end);
    if (end == next || *end != terminator || !std::isfinite(number)) return std::nullopt;
    list += (list.empty() ? "[" : ", ") + as_toml(number);
    next = end + 1;
  }
  return list + "]";
}

/// A part of --aid: a number with its unit, and the parameter in SI units that it stands for.
struct AidPart {
  const char* key;
  std::string_view unit;
  double in_si;
};

constexpr AidPart kAidParts[] = {{"plant.sensors.aid_rate", "Hz", 1.0},
                                 {"plant.sensors.aid_noise", "mm", 1e-3},
                                 {"plant.sensors.aid_delay", "ms", 1e-3}};

/// "10Hz:5mm:50ms" as overrides; absent when it is not three finite numbers with these units.
std::optional<std::vector<std::string>> aid_overrides(const std::string& text) {
  std::vector<std::string> out;
  std::string_view rest = text;
  for (const AidPart& part : kAidParts) {
    if (!out.empty()) {
      if (!rest.starts_with(':')) return std::nullopt;
      rest.remove_prefix(1);
    }
    double number = 0.0;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    if (error != std::errc{} || !std::isfinite(number)) return std::nullopt;
    rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
    if (!rest.starts_with(part.unit)) return std::nullopt;
    rest.remove_prefix(part.unit.size());
    out.push_back(part.key + ("=" + as_toml(number * part.in_si)));
  }
  return rest.empty() ? std::optional(out) : std::nullopt;
}

}  // namespace

void ConfigOptions::add_common(CLI::App& command) {
  command.add_option("--config", file_, "TOML file of parameters, such as the run.toml of a run")
      ->type_name("FILE");
  command.add_option("--set", sets_, "One parameter, such as gait.period=0.3; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
  command.add_option("--robot", robot_, "Folder under robots/, or an MJCF file [mini_cheetah]")
      ->type_name("NAME|FILE");
  command.add_option("--controller", controller_, "mit, fkm, asc or pirouette [pirouette]")
      ->type_name("NAME");
  command.add_option("--profile", profile_, "Plant: nominal or realistic [nominal]")
      ->type_name("NAME");
}

void ConfigOptions::add_run(CLI::App& command) {
  add_shortcut(command, {"--rate", "run.rate"}, "RAD/S", "Yaw rate; positive turns left [0.7]");
  CLI::Option* turns =
      add_shortcut(command, {"--turns", "run.turns"}, "N", "Turns to record after settling [8]");
  add_shortcut(command, {"--angle", "run.angle_deg"}, "DEG",
               "Turn by this angle, positive to the left, then stand")
      ->excludes(turns);
  add_shortcut(command, {"--terrain", "plant.terrain"}, "WHAT",
               "flat, slope:10 (degrees), slope:10+rough:0.02, stairs:0.03x0.20 (m), "
               "stairs:0.03x0.20@30, rough:0.04, blocks:0.05, patch:0.3x0.6 (friction, m) or "
               "soft:0.05 (s); lengths also in shares of the CoM's height, stairs:11%x74% [flat]");
  add_shortcut(command, {"--estimator", "estimation.source"}, "WHICH", "kalman or truth [kalman]");
  command.add_option("--sensors", sensors_, "noisy or ideal [noisy]")->type_name("WHICH");
  command
      .add_option("--aid", aid_,
                  "Poses of the trunk from outside: rate, noise, delay, such as 10Hz:5mm:50ms "
                  "[none]")
      ->type_name("RATE:NOISE:DELAY");
  add_shortcut(command, {"--seed", "run.seed"}, "N", "Of noise, biases and terrain [1]");
  add_shortcut(command, {"--point", "run.point", true}, "X,Y",
               "Commanded point in the world, m [where the CoM stands when the gait starts]");
  add_shortcut(command, {"--start-offset", "run.start_offset", true}, "X,Y",
               "Where the robot starts, m; it goes to the point, 0,0 unless given [0,0]");
  add_shortcut(command, {"--start-yaw-deg", "run.start_yaw_deg"}, "DEG",
               "Yaw at which the robot starts; it turns to 0 [0]");
}

void ConfigOptions::add_turn(CLI::App& command) {
  is_turn_ = true;
  CLI::Option* path =
      add_shortcut(command, {"--path", "run.path"}, "NAME|FILE.toml",
                   "Path to follow: a name under experiments/paths/, or a file of waypoints");
  add_shortcut(command, {"--laps", "run.laps"}, "N", "Laps of a closed path to record [2]");
  CLI::Option* radius =
      command
          .add_option("--radius", radius_,
                      "Signed radius of a circle, m; the velocity is radius times rate")
          ->type_name("M");
  command
      .add_option("--speed", speed_,
                  "Along the path, or with --rate along a circle, else along a straight line, m/s")
      ->type_name("M/S")
      ->excludes(radius);
  CLI::Option* offset = command
                            .add_option("--heading-offset-deg", heading_offset_deg_,
                                        "Direction of travel from the robot's front: 90 is to its "
                                        "left, 180 backwards [0]")
                            ->type_name("DEG");
  for (CLI::Option* other : {radius, offset, command.get_option("--rate"),
                             command.get_option("--turns"), command.get_option("--angle")}) {
    path->excludes(other);
  }
}

CLI::Option* ConfigOptions::add_shortcut(CLI::App& command, Shortcut shortcut,
                                         const std::string& placeholder, const std::string& help) {
  Shortcut& kept = shortcuts_.emplace_back(std::move(shortcut));
  return command.add_option(kept.option, kept.text, help)->type_name(placeholder);
}

bool ConfigOptions::is_given(const std::string& option) const {
  return std::any_of(shortcuts_.begin(), shortcuts_.end(),
                     [&](const Shortcut& s) { return s.option == option && s.text; });
}

std::vector<std::string> ConfigOptions::turn_overrides(const Config& config) const {
  std::vector<std::string> out;
  if (!radius_ && !speed_) return out;
  const bool on_path = !radius_ && !config.run.path.empty();
  if (on_path) return {"run.path_speed=" + as_toml(*speed_)};

  const double rate = radius_ || is_given("--rate") ? config.run.rate : 0.0;
  const double speed = radius_ ? *radius_ * rate : *speed_;
  const double direction = radians(heading_offset_deg_.value_or(0.0));
  constexpr double kDigits = 1e12;  // a cosine of 90 degrees is to be 0
  const auto component = [&](double share) {
    return as_toml(std::round(speed * share * kDigits) / kDigits);
  };
  return {"run.path=\"\"", "run.rate=" + as_toml(rate),
          "run.velocity=[" + component(std::cos(direction)) + ", " +
              component(std::sin(direction)) + "]"};
}

std::vector<std::string> ConfigOptions::overrides(Errors& errors) const {
  std::vector<std::string> out;
  if (is_turn_ && !radius_ && !speed_ && !is_given("--path") && !file_) {
    errors.push_back({"--radius", 0, "", "missing; or give --speed, --path or --config"});
  }
  if (heading_offset_deg_ && !radius_ && !speed_) {
    errors.push_back({"--heading-offset-deg", 0, "", "needs --radius or --speed"});
  }
  const std::pair<const char*, std::optional<double>> numbers[] = {
      {"--radius", radius_}, {"--speed", speed_}, {"--heading-offset-deg", heading_offset_deg_}};
  for (const auto& [option, number] : numbers) {
    if (number && !std::isfinite(*number)) {
      errors.push_back({option, 0, "", "given " + as_toml(*number) + "; allowed: a finite number"});
    }
  }
  for (const Shortcut& s : shortcuts_) {
    if (!s.text) continue;
    const auto value = s.is_pair ? pair_as_toml(*s.text) : s.text;
    if (!value) {
      errors.push_back(
          {s.option, 0, "", "given " + quoted(*s.text) + "; allowed: X,Y in m, such as 0.1,-0.2"});
      continue;
    }
    if (s.key == "run.angle_deg" && std::strtod(value->c_str(), nullptr) == 0.0) {
      errors.push_back({s.option, 0, "",
                        "given " + quoted(*value) +
                            "; allowed: an angle in "
                            "degrees other than 0"});
      continue;
    }
    out.push_back(s.key + "=" + *value);
    if (s.key == "run.turns") out.push_back("run.angle_deg=0");  // of a file: they were typed
    if (s.key == "run.point") out.push_back("run.fixed_point=true");
  }
  if (sensors_ && *sensors_ != "ideal" && *sensors_ != "noisy") {
    errors.push_back(
        {"--sensors", 0, "", "given " + quoted(*sensors_) + "; allowed: noisy, ideal"});
  } else if (sensors_) {
    out.push_back(std::string("plant.sensors.ideal=") + (*sensors_ == "ideal" ? "true" : "false"));
  }
  if (aid_) {
    if (const auto aid = aid_overrides(*aid_)) {
      out.insert(out.end(), aid->begin(), aid->end());
    } else {
      errors.push_back({"--aid", 0, "",
                        "given " + quoted(*aid_) +
                            "; allowed: rate in Hz, noise in mm and delay in ms, such as "
                            "10Hz:5mm:50ms"});
    }
  }
  out.insert(out.end(), sets_.begin(), sets_.end());
  return out;
}

Result<Config> ConfigOptions::load_with(const std::vector<std::string>& overrides) const {
  ConfigSources sources{robot_, controller_, profile_, std::nullopt, overrides};
  if (file_) sources.file = *file_;
  Result<Config> config = load_config(sources);
  if (config) return config;
  return in_typed_words(config.errors());
}

Errors ConfigOptions::in_typed_words(Errors errors) const {
  for (Error& error : errors) {
    if (error.file == "--robot" || error.file == "--controller" || error.file == "--profile")
      error.key.clear();
    if (!error.file.empty() && error.file != "--set") continue;
    for (const Shortcut& s : shortcuts_) {
      if (s.text && s.key == error.key) error = {s.option, 0, "", error.message};
    }
    const bool is_aid =
        aid_ && std::any_of(std::begin(kAidParts), std::end(kAidParts),
                            [&](const AidPart& part) { return error.key == part.key; });
    if (is_aid) {
      error = {"--aid", 0, "", "given " + quoted(*aid_) + "; " + error.key + ": " + error.message};
    }
    if ((radius_ || speed_) && error.key == "run.velocity") {
      error = {radius_ ? "--radius" : "--speed", 0, "",
               "given " + as_toml(radius_.value_or(speed_.value_or(0.0))) +
                   "; run.velocity: " + error.message};
    }
    if (speed_ && error.key == "run.path_speed") error = {"--speed", 0, "", error.message};
  }
  return errors;
}

Result<Config> ConfigOptions::load() const {
  Errors errors;
  std::vector<std::string> texts = overrides(errors);
  Result<Config> config = load_with(texts);
  if (config && errors.empty()) {
    const std::vector<std::string> turn = turn_overrides(config.value());
    texts.insert(texts.end(), turn.begin(), turn.end());
    if (!turn.empty()) config = load_with(texts);
  }
  if (!config) errors.insert(errors.end(), config.errors().begin(), config.errors().end());
  if (!errors.empty()) return errors;
  return config;
}

}  // namespace pirouette::app
