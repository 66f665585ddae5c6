#include "pirouette/base/memory.hpp"

#include <gtest/gtest.h>

#include "pirouette/base/math.hpp"

namespace pirouette {
namespace {

enum class Colour : int { kRed = 1, kBlue = 2 };

struct Plain {
  bool flag = false;
  Colour colour = Colour::kRed;
  Vec3 v = Vec3::Zero();
  PerLeg<int> count{};
  std::array<Vec2, 2> pair = {Vec2::Zero(), Vec2::Zero()};
};

/// One of everything that may be a member.
class Everything {
 public:
  template <class Self, class Visit>
  static void memory(Self& self, Visit&& visit) {
    auto& [parameter, plain, turn, maybe, either, many] = self;
    visit(plain, turn, maybe, either, many);
  }

  bool operator==(const Everything& other) const {
    return plain.flag == other.plain.flag && plain.colour == other.plain.colour &&
           plain.v == other.plain.v && plain.count.values == other.plain.count.values &&
           plain.pair == other.plain.pair && turn.coeffs() == other.turn.coeffs() &&
           maybe == other.maybe && either == other.either && many == other.many;
  }

  double parameter = 0.0;
  Plain plain;
  Quat turn = Quat::Identity();
  std::optional<double> maybe;
  std::variant<int, double> either;
  std::vector<int> many;
};

Everything sample() {
  Everything e;
  e.parameter = 5.0;
  e.plain = {true, Colour::kBlue, Vec3(1.0, -2.0, 3.0), {{1, 2, 3, 4}}, {Vec2(1, 2), Vec2(3, 4)}};
  e.turn = Quat(0.5, -0.5, 0.5, 0.5);
  e.maybe = 0.1;
  e.either = 7.5;
  e.many = {3, 1, 4, 1, 5};
  return e;
}

std::vector<std::byte> bytes_of(const Everything& e) {
  std::vector<std::byte> out;
  MemoryWriter write(out);
  write(e);
  return out;
}

TEST(Memory, ComesBackWhateverWasThereBefore) {
  const Everything given = sample();
  Everything other;
  other.many = {9, 9};
  for (Everything read : {Everything{}, given, other}) {
    const double own = read.parameter;
    for (const Everything& wanted : {given, Everything{}, other}) {
      const std::vector<std::byte> bytes = bytes_of(wanted);
      MemoryReader reader(bytes);
      reader(read);
      EXPECT_TRUE(reader.complete());
      EXPECT_TRUE(read == wanted);
      EXPECT_EQ(read.parameter, own);  // not in the list
    }
  }
}

TEST(Memory, NoticesEveryByteThatIsMissingOrTooMany) {
  const std::vector<std::byte> bytes = bytes_of(sample());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Everything read;
    MemoryReader reader{std::span(bytes).first(size)};
    reader(read);
    EXPECT_FALSE(reader.complete()) << size;
  }
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  Everything read;
  MemoryReader reader(longer);
  reader(read);
  EXPECT_FALSE(reader.complete());
}

TEST(Memory, AsksForNoMoreMemoryThanTheBytesCanFill) {
  const std::uint64_t size = ~std::uint64_t{0};
  std::vector<std::byte> bytes;
  MemoryWriter write(bytes);
  write(size);
  std::vector<double> read;
  MemoryReader reader(bytes);
  reader(read);
  EXPECT_FALSE(reader.complete());
  EXPECT_TRUE(read.empty());
}

}  // namespace
}  // namespace pirouette
