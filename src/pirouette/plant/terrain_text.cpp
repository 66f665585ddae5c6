// The text of plant.terrain.
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "pirouette/base/fields.hpp"
#include "pirouette/plant/terrain.hpp"

namespace pirouette {
namespace {

/// One number of a terrain's text.
struct Quantity {
  std::string_view meaning;
  Range range;
};

constexpr Quantity kSlope{"the slope in degrees", {0.0, 40.0}};
constexpr Quantity kRise{"the rise in metres", {0.0, 0.2}};
constexpr Quantity kRun{"the run in metres", {0.1, 1.0}};
constexpr Quantity kDirection{"the direction in degrees", {-180.0, 180.0}};
constexpr Quantity kRoughHeight{"the height in metres", {0.0, 0.1}};
constexpr Quantity kBlockHeight{"the height in metres", {0.0, 0.2}};
constexpr Quantity kFriction{"the friction", {0.0, 5.0}};
constexpr Quantity kSide{"the side in metres", {0.1, 10.0}};
constexpr Quantity kTimeConstant{"the time constant in seconds", {0.002, 0.5}};

constexpr std::string_view kGrammar =
    "flat, slope:DEGREES (0 to 40), slope:DEGREES+rough:HEIGHT, stairs:RISExRUN (m; rise 0 to "
    "0.2, run 0.1 to 1), stairs:RISExRUN@DEGREES (-180 to 180, from x to the direction of "
    "climbing), rough:HEIGHT (m; 0 to 0.1), blocks:HEIGHT (m; 0 to 0.2), patch:FRICTIONxSIDE (0 to "
    "5; m, 0.1 to 10) or soft:TIME_CONSTANT (s; 0.002 to 0.5)";

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string shortest(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::to_string(value);
}

Error terrain_error(std::string_view given, const std::string& reason) {
  return {"", 0, "plant.terrain", "\"" + std::string(given) + "\": " + reason};
}

/// Text before the first `separator` and after it; absent without one.
std::optional<std::array<std::string_view, 2>> split(std::string_view text, char separator) {
  const std::size_t at = text.find(separator);
  if (at == std::string_view::npos) return std::nullopt;
  return std::array{text.substr(0, at), text.substr(at + 1)};
}

/// The text of one terrain, taken apart into its numbers.
class TerrainText {
 public:
  explicit TerrainText(std::string_view text) : text_(text) {}

  Result<TerrainSpec> parse() {
    const TerrainSpec spec = read();
    if (is_unknown_) return terrain_error(text_, "expected " + std::string(kGrammar));
    if (!errors_.empty()) return errors_;
    return spec;
  }

 private:
  TerrainSpec read() {
    if (text_ == "flat") return FlatGround{};
    const auto parts = split(text_, ':');
    if (!parts) return unknown();
    const auto [kind, rest] = *parts;
    if (kind == "slope") return read_slope(rest);
    if (kind == "stairs") return read_stairs(rest);
    if (kind == "rough") return RoughGround{number(rest, kRoughHeight)};
    if (kind == "blocks") return Blocks{number(rest, kBlockHeight)};
    if (kind == "patch") return read_patch(rest);
    if (kind == "soft") return SoftGround{number(rest, kTimeConstant)};
    return unknown();
  }

  TerrainSpec read_slope(std::string_view rest) {
    constexpr std::string_view kRough = "rough:";
    const auto parts = split(rest, '+');
    if (!parts) return Slope{number(rest, kSlope)};
    const auto [degrees, added] = *parts;
    if (!added.starts_with(kRough)) return unknown();
    const double slope = number(degrees, kSlope);
    return RoughGround{number(added.substr(kRough.size()), kRoughHeight), slope};
  }

  TerrainSpec read_stairs(std::string_view rest) {
    const auto directed = split(rest, '@');
    const auto sizes = split(directed ? (*directed)[0] : rest, 'x');
    if (!sizes) return unknown();
    const double rise = number((*sizes)[0], kRise), run = number((*sizes)[1], kRun);
    return Stairs{rise, run, directed ? number((*directed)[1], kDirection) : 0.0};
  }

  TerrainSpec read_patch(std::string_view rest) {
    const auto parts = split(rest, 'x');
    if (!parts) return unknown();
    const double friction = number((*parts)[0], kFriction);
    return Patch{friction, number((*parts)[1], kSide)};
  }

  /// The number that `text` is; notes if it is none or out of range.
  double number(std::string_view text, const Quantity& quantity) {
    const std::optional<double> value = parse_number(text);
    is_unknown_ = is_unknown_ || !value;
    const auto& [min, max] = quantity.range;
    if (value && (*value < min || *value > max)) {
      errors_.push_back(terrain_error(text_, std::string(quantity.meaning) + " is " +
                                                 shortest(*value) + "; allowed " + shortest(min) +
                                                 " to " + shortest(max)));
    }
    return value.value_or(0.0);
  }

  TerrainSpec unknown() {
    is_unknown_ = true;
    return FlatGround{};
  }

  std::string_view text_;
  bool is_unknown_ = false;
  Errors errors_;
};

struct Writer {
  std::string operator()(const FlatGround&) const { return "flat"; }
  std::string operator()(const Slope& slope) const { return "slope:" + shortest(slope.degrees); }
  std::string operator()(const Stairs& stairs) const {
    const std::string text = "stairs:" + shortest(stairs.rise) + "x" + shortest(stairs.run);
    return stairs.degrees == 0.0 ? text : text + "@" + shortest(stairs.degrees);
  }
  std::string operator()(const RoughGround& rough) const {
    const std::string text = "rough:" + shortest(rough.height);
    if (rough.slope_degrees == 0.0) return text;
    return "slope:" + shortest(rough.slope_degrees) + "+" + text;
  }
  std::string operator()(const Blocks& blocks) const { return "blocks:" + shortest(blocks.height); }
  std::string operator()(const Patch& patch) const {
    return "patch:" + shortest(patch.friction) + "x" + shortest(patch.side);
  }
  std::string operator()(const SoftGround& soft) const {
    return "soft:" + shortest(soft.time_constant);
  }
};

}  // namespace

Result<TerrainSpec> parse_terrain(std::string_view text) { return TerrainText(text).parse(); }

std::string to_string(const TerrainSpec& spec) { return std::visit(Writer{}, spec); }

}  // namespace pirouette
