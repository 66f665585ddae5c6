#include "pirouette/base/unit_law.hpp"

#include <cctype>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace pirouette {
namespace {

/// Reads a unit from left to right; the exponents of what stands behind a slash are negative.
class UnitReader {
 public:
  explicit UnitReader(std::string_view unit) : rest_(unit) {}

  UnitLaw read() {
    const UnitLaw law = product();
    if (!rest_.empty()) fail();
    return law;
  }

 private:
  [[noreturn]] void fail() const {
    throw std::invalid_argument("no unit: ..." + std::string(rest_));
  }

  static void add(UnitLaw& sum, const UnitLaw& law, double times) {
    sum.length += times * law.length;
    sum.mass += times * law.mass;
    sum.time += times * law.time;
  }

  UnitLaw product() {
    UnitLaw law;
    double direction = 1.0;
    while (!rest_.empty() && rest_.front() != ')') {
      if (rest_.front() == ' ') {
        rest_.remove_prefix(1);
      } else if (rest_.front() == '/') {
        direction = -1.0;
        rest_.remove_prefix(1);
      } else {
        const UnitLaw base = rest_.front() == '(' ? bracket() : symbol();
        add(law, base, direction * exponent());
      }
    }
    return law;
  }

  UnitLaw bracket() {
    rest_.remove_prefix(1);
    const UnitLaw law = product();
    if (rest_.empty()) fail();
    rest_.remove_prefix(1);
    return law;
  }

  double exponent() {
    if (rest_.size() < 2 || rest_.front() != '^') return 1.0;
    const double value = rest_[1] - '0';
    rest_.remove_prefix(2);
    return value;
  }

  UnitLaw symbol() {
    std::size_t size = 0;
    while (size < rest_.size() && std::isalnum(static_cast<unsigned char>(rest_[size])) != 0)
      ++size;
    const std::string_view name = rest_.substr(0, size);
    UnitLaw law;
    if (name == "m") {
      law.length = 1.0;
    } else if (name == "s") {
      law.time = 1.0;
    } else if (name == "Hz") {
      law.time = -1.0;
    } else if (name == "kg") {
      law.mass = 1.0;
    } else if (name == "N") {
      law = {1.0, 1.0, -2.0};
    } else if (name != "1" && name != "rad" && name != "deg" && name != "steps") {
      fail();
    }
    rest_.remove_prefix(size);
    return law;
  }

  std::string_view rest_;
};

std::string power(const char* name, double exponent) {
  if (exponent == 0.0) return "";
  if (exponent == 1.0) return name;
  std::ostringstream text;
  text << name << '^' << exponent;
  return text.str();
}

}  // namespace

UnitLaw unit_law(std::string_view unit) { return UnitReader(unit).read(); }

std::string law_text(const UnitLaw& law) {
  const std::string mass = power("u", law.mass);
  const std::string length = power("l", law.length + 0.5 * law.time);
  return mass + (mass.empty() || length.empty() ? "" : " ") + length;
}

}  // namespace pirouette
