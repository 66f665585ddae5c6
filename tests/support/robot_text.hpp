// The robot's MJCF as text, and ways to change it.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "pirouette/base/legs.hpp"
#include "support/mini_cheetah.hpp"

namespace pirouette::test {

inline std::string text_of_robot() {
  std::ostringstream text;
  text << std::ifstream(kRobot).rdbuf();
  return text.str();
}

/// The robot file `text` with its legs in the order RL RR FL FR.
inline std::string with_legs_reversed(const std::string& text) {
  std::array<std::size_t, kLegCount + 1> begin{};
  for (const Leg leg : kLegs) {
    begin[index(leg)] = text.find("<body name=\"" + std::string(name(leg)) + "_abad_rotor\"");
  }
  begin[kLegCount] = text.rfind("</body>", text.find("</worldbody>"));
  std::string out = text.substr(0, begin[0]);
  for (std::size_t i = kLegCount; i-- > 0;) out += text.substr(begin[i], begin[i + 1] - begin[i]);
  return out + text.substr(begin[kLegCount]);
}

/// Path of the written file.
inline std::string write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
  return path.string();
}

}  // namespace pirouette::test
