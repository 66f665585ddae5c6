#include "pirouette/plant/terrain.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "pirouette/plant/scene.hpp"

namespace pirouette {
namespace {

Terrain make_terrain(const std::string& text, std::uint64_t seed = 1) {
  return Terrain(parse_terrain(text).value(), seed);
}

ModelPtr compile_ground(const Terrain& terrain) {
  const SpecPtr spec(mj_makeSpec());
  terrain.add_to(*spec, Vec3(0.8, 0.005, 0.0001));
  return ModelPtr(mj_compile(spec.get(), nullptr));
}

TEST(TerrainText, ReadsEveryKind) {
  EXPECT_TRUE(std::holds_alternative<FlatGround>(parse_terrain("flat").value()));
  EXPECT_DOUBLE_EQ(std::get<Slope>(parse_terrain("slope:12.5").value()).degrees, 12.5);
  const auto stairs = std::get<Stairs>(parse_terrain("stairs:0.03x0.20").value());
  EXPECT_DOUBLE_EQ(stairs.rise, 0.03);
  EXPECT_DOUBLE_EQ(stairs.run, 0.2);
  EXPECT_DOUBLE_EQ(stairs.degrees, 0.0);
  EXPECT_DOUBLE_EQ(std::get<Stairs>(parse_terrain("stairs:0.03x0.2@-30").value()).degrees, -30.0);
  EXPECT_DOUBLE_EQ(std::get<RoughGround>(parse_terrain("rough:0.04").value()).height, 0.04);
  const auto both = std::get<RoughGround>(parse_terrain("slope:10+rough:0.02").value());
  EXPECT_DOUBLE_EQ(both.slope_degrees, 10.0);
  EXPECT_DOUBLE_EQ(both.height, 0.02);
  EXPECT_DOUBLE_EQ(std::get<Blocks>(parse_terrain("blocks:0.05").value()).height, 0.05);
  const auto patch = std::get<Patch>(parse_terrain("patch:0.3x0.6").value());
  EXPECT_DOUBLE_EQ(patch.friction, 0.3);
  EXPECT_DOUBLE_EQ(patch.side, 0.6);
  EXPECT_DOUBLE_EQ(std::get<SoftGround>(parse_terrain("soft:0.05").value()).time_constant, 0.05);
}

TEST(TerrainText, ComesBackAsItWasRead) {
  for (const std::string text :
       {"flat", "slope:10", "slope:0.1", "stairs:0.03x0.2", "stairs:0.03x0.2@30", "rough:0.04",
        "slope:10+rough:0.02", "blocks:0.05", "patch:0.3x0.6", "soft:0.05"}) {
    EXPECT_EQ(to_string(parse_terrain(text).value()), text);
  }
}

TEST(TerrainText, IsRejectedWithWhatWasGivenAndWhatIsAllowed) {
  for (const std::string text : {"",
                                 "hill",
                                 "flat:",
                                 "flat:1",
                                 "slope",
                                 "slope:",
                                 "slope:ten",
                                 "slope:10deg",
                                 "slope:nan",
                                 "slope: 10",
                                 "stairs:0.03",
                                 "stairs:0.03x",
                                 "stairs:x0.2",
                                 "stairs:0.03x0.2x1",
                                 "stairs:0.03x0.2@",
                                 "stairs:0.03@30",
                                 "stairs:0.03x0.2@30@30",
                                 "rough:",
                                 "rough:0.02+slope:10",
                                 "slope:10+",
                                 "slope:10+stairs:0.03x0.2",
                                 "slope:10+rough:0.02+rough:0.02",
                                 "blocks",
                                 "blocks:0.05x0.1",
                                 "patch:0.3",
                                 "soft:",
                                 "soft:0.05s",
                                 "Flat"}) {
    const Result<TerrainSpec> result = parse_terrain(text);
    ASSERT_FALSE(result.ok()) << text;
    const std::string message = result.errors().front().to_string();
    EXPECT_NE(message.find("plant.terrain"), std::string::npos) << message;
    EXPECT_NE(message.find("\"" + text + "\""), std::string::npos) << message;
    EXPECT_NE(message.find("stairs:RISExRUN"), std::string::npos) << message;
  }
}

TEST(TerrainText, NamesTheRangeThatWasLeft) {
  const auto message = [](const char* text) {
    return parse_terrain(text).errors().front().message;
  };
  EXPECT_NE(message("slope:41").find("41; allowed 0 to 40"), std::string::npos);
  EXPECT_NE(message("slope:-1").find("-1; allowed 0 to 40"), std::string::npos);
  EXPECT_NE(message("rough:0.2").find("0.2; allowed 0 to 0.1"), std::string::npos);
  EXPECT_NE(message("blocks:0.3").find("0.3; allowed 0 to 0.2"), std::string::npos);
  EXPECT_NE(message("soft:0.001").find("0.001; allowed 0.002 to 0.5"), std::string::npos);
  EXPECT_EQ(parse_terrain("stairs:0.3x0.05@200").errors().size(), 3U);  // rise, run and direction
  EXPECT_EQ(parse_terrain("patch:6x0").errors().size(), 2U);
}

TEST(Terrain, SlopeRisesAlongX) {
  const Terrain slope = make_terrain("slope:30");
  EXPECT_NEAR(slope.height({2.0, -1.0}), 2.0 * std::tan(radians(30.0)), 1e-12);
  EXPECT_LT(slope.normal().x(), 0.0);
  const Vec3 uphill(1.0, 0.0, slope.height({1.0, 0.0}));
  EXPECT_NEAR(slope.normal().dot(uphill), 0.0, 1e-12);
}

TEST(Terrain, StairsHaveTheOriginInTheMiddleOfATread) {
  const Terrain stairs = make_terrain("stairs:0.05x0.3");
  EXPECT_DOUBLE_EQ(stairs.height({0.0, 0.0}), 0.0);
  EXPECT_DOUBLE_EQ(stairs.height({0.149, 2.0}), 0.0);
  EXPECT_DOUBLE_EQ(stairs.height({0.151, 2.0}), 0.05);
  EXPECT_DOUBLE_EQ(stairs.height({-0.151, -2.0}), -0.05);
  EXPECT_DOUBLE_EQ(stairs.height({0.6, 0.0}), 0.1);
  EXPECT_NEAR(stairs.normal().dot(Vec3(0.3, 0.0, 0.05)), 0.0, 1e-12);
}

TEST(Terrain, BesideEdgesABallTouchesNone) {
  const Terrain stairs(parse_terrain("stairs:0.05x0.20@30").value(), 1);
  const double r = 0.03;
  for (double x = -0.5; x < 0.5; x += 0.013) {
    const Vec2 xy(x, 0.3 * x), moved = stairs.beside_edges(xy, r);
    EXPECT_EQ(stairs.height(moved), stairs.height(xy));  // the same tread
    EXPECT_NEAR(stairs.ball_height(moved, r), stairs.height(xy) + r, 1e-12);
    EXPECT_LE((moved - xy).norm(), r + 1.1e-4);
  }
  const Terrain flat(parse_terrain("flat").value(), 1);
  EXPECT_EQ(flat.beside_edges(Vec2(0.1, 0.2), r), Vec2(0.1, 0.2));
}

TEST(Terrain, StairsAtAnAngleClimbInTheirDirection) {
  const Terrain turned = make_terrain("stairs:0.05x0.3@30"),
                straight = make_terrain("stairs:0.05x0.3");
  const Mat2 R = rot2(radians(30.0));
  for (double along = -1.0; along < 1.0; along += 0.07) {
    const Vec2 xy(along, 0.4);
    EXPECT_NEAR(turned.height(R * xy), straight.height(xy), 1e-12);
    EXPECT_NEAR(turned.ball_height(R * xy, 0.02), straight.ball_height(xy, 0.02), 1e-12);
  }
  EXPECT_NEAR((turned.normal() - rot_z(radians(30.0)) * straight.normal()).norm(), 0.0, 1e-12);
  EXPECT_LT(half_extent(parse_terrain("stairs:0.05x0.3@30").value()),
            half_extent(parse_terrain("stairs:0.05x0.3").value()));
}

TEST(Terrain, RoughSlopeIsTheRoughGroundAddedToTheSlope) {
  const Terrain both = make_terrain("slope:20+rough:0.04"), slope = make_terrain("slope:20"),
                rough = make_terrain("rough:0.04");
  for (double x = -4.9; x < 5.0; x += 0.37) {
    const Vec2 xy(x, 0.7 * x);
    // Heights of the whole slope, 3.6 m, in single precision.
    EXPECT_NEAR(both.height(xy), slope.height(xy) + rough.height(xy), 4e-7);
  }
  EXPECT_EQ(both.normal(), slope.normal());
  EXPECT_EQ(make_terrain("slope:20+rough:0").height({0.3, 0.2}), slope.height({0.3, 0.2}));
}

TEST(Terrain, BlocksHaveHeightsUpToTheGivenOneOnFlatGround) {
  const Terrain blocks = make_terrain("blocks:0.05");
  double highest = 0.0;
  int count = 0, on_blocks = 0;
  for (double x = -2.0; x < 2.0; x += 0.011) {
    for (double y = -2.0; y < 2.0; y += 0.013) {
      const double height = blocks.height({x, y});
      EXPECT_GE(height, 0.0);
      highest = std::max(highest, height);
      ++count;
      on_blocks += height > 0.0 ? 1 : 0;
    }
  }
  EXPECT_LE(highest, 0.05);
  EXPECT_GT(highest, 0.049);  // the highest of 400 draws
  // Mean of squares of 0.1 to 0.15 m in cells of 0.2 m: 0.396, less what overlaps.
  EXPECT_NEAR(static_cast<double>(on_blocks) / count, 0.38, 0.03);
  EXPECT_EQ(blocks.height({2.5, 0.1}), 0.0);
  EXPECT_EQ(blocks.normal(), Vec3(Vec3::UnitZ()));
}

TEST(Terrain, PatchSpansHalfOfTheFootholdsAroundTheOrigin) {
  const Terrain patch = make_terrain("patch:0.3x0.6");
  const auto at = [&](double x, double y) { return patch.friction({x, y}, 0.8); };
  EXPECT_EQ(at(0.19, 0.11), 0.3);
  EXPECT_EQ(at(0.19, -0.11), 0.3);
  EXPECT_EQ(at(-0.19, 0.11), 0.8);
  EXPECT_EQ(at(0.61, 0.0), 0.8);
  EXPECT_EQ(at(0.3, 0.31), 0.8);
  EXPECT_EQ(make_terrain("flat").friction({0.19, 0.11}, 0.8), 0.8);
}

TEST(Terrain, SoftGroundAloneHasATimeConstantOfItsOwn) {
  EXPECT_EQ(make_terrain("soft:0.05").contact_time_constant(0.02), 0.05);
  EXPECT_EQ(make_terrain("flat").contact_time_constant(0.02), 0.02);
}

TEST(Terrain, RoughGroundHasZeroMeanAndTheGivenPeakToValley) {
  const Terrain rough = make_terrain("rough:0.04");
  double lowest = 1.0, highest = -1.0, sum = 0.0;
  int count = 0;
  for (double x = -5.0; x <= 5.0; x += 1.0 / 32.0) {  // the points of its grid
    for (double y = -5.0; y <= 5.0; y += 1.0 / 32.0) {
      const double height = rough.height({x, y});
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
      sum += height;
      ++count;
    }
  }
  // Heights are stored in single precision.
  EXPECT_NEAR(highest - lowest, 0.04, 1e-8);
  EXPECT_NEAR(sum / count, 0.0, 1e-8);
}

TEST(Terrain, RoughGroundIsGentleAtTheScaleOfAFoot) {
  const Terrain rough = make_terrain("rough:0.04");
  double steepest = 0.0;
  for (double x = -4.0; x < 4.0; x += 0.013) {
    for (double y = -4.0; y < 4.0; y += 0.11) {
      steepest =
          std::max(steepest, std::abs(rough.height({x + 0.01, y}) - rough.height({x, y})) / 0.01);
    }
  }
  EXPECT_GT(steepest, 0.1);
  EXPECT_LT(steepest, 0.4);  // about 22 degrees
}

TEST(Terrain, BlocksFollowTheirSeedAlone) {
  const auto profile = [](std::uint64_t seed) {
    const Terrain blocks = make_terrain("blocks:0.05", seed);
    std::vector<double> heights;
    for (double x = -1.0; x < 1.0; x += 0.02) heights.push_back(blocks.height({x, 0.1}));
    return heights;
  };
  EXPECT_EQ(profile(7), profile(7));
  EXPECT_NE(profile(7), profile(8));
}

TEST(Terrain, RoughGroundFollowsItsSeedAlone) {
  EXPECT_EQ(make_terrain("rough:0.04", 7).height({0.31, 0.2}),
            make_terrain("rough:0.04", 7).height({0.31, 0.2}));
  EXPECT_NE(make_terrain("rough:0.04", 7).height({0.31, 0.2}),
            make_terrain("rough:0.04", 8).height({0.31, 0.2}));
  // The same field with every compiler: seed 1 at the origin.
  EXPECT_NEAR(make_terrain("rough:0.04", 1).height({0.0, 0.0}), 0.01221903, 1e-8);
}

class EveryGround : public testing::TestWithParam<const char*> {};

// MuJoCo's ray caster is the oracle for the shape that the feet meet.
TEST_P(EveryGround, HasTheHeightThatARayFromAboveFinds) {
  const Terrain terrain = make_terrain(GetParam(), 3);
  const ModelPtr model = compile_ground(terrain);
  ASSERT_NE(model, nullptr);
  const DataPtr data(mj_makeData(model.get()));
  mj_forward(model.get(), data.get());
  for (double x = -1.97; x < 2.0; x += 0.217) {
    for (double y = -1.93; y < 2.0; y += 0.191) {
      const Vec3 from(x, y, 3.0), down(0.0, 0.0, -1.0);
      int geom = -1;
      const double distance =
          mj_ray(model.get(), data.get(), from.data(), down.data(), nullptr, 1, -1, &geom, nullptr);
      ASSERT_GE(geom, 0);
      // Single-precision heights.
      EXPECT_NEAR(3.0 - distance, terrain.height({x, y}), 1e-6) << x << " " << y;
    }
  }
}

TEST_P(EveryGround, BearsABallAtItsBallHeight) {
  constexpr double kRadius = 0.0225;
  const Terrain terrain = make_terrain(GetParam(), 3);
  const SpecPtr spec(mj_makeSpec());
  terrain.add_to(*spec, Vec3(0.8, 0.005, 0.0001));
  mjsBody* ball = mjs_addBody(mjs_findBody(spec.get(), "world"), nullptr);
  mjs_addFreeJoint(ball);
  mjsGeom* sphere = mjs_addGeom(ball, nullptr);
  sphere->type = mjGEOM_SPHERE;
  sphere->size[0] = kRadius;
  const ModelPtr model(mj_compile(spec.get(), nullptr));
  ASSERT_NE(model, nullptr) << mjs_getError(spec.get());
  const DataPtr data(mj_makeData(model.get()));
  for (double x = -0.5; x < 0.5; x += 0.0617) {
    const Vec2 xy(x, 0.37);
    // On rough ground the envelope is sampled: less than 0.1 mm off.
    for (const double gap : {1e-4, -1e-4}) {
      Eigen::Map<Vec3>(data->qpos) << xy, terrain.ball_height(xy, kRadius) + gap;
      mj_forward(model.get(), data.get());
      EXPECT_EQ(data->ncon > 0, gap < 0.0) << x << " " << gap;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryGround,
                         testing::Values("flat", "slope:25", "stairs:0.05x0.2", "stairs:0x0.2",
                                         "stairs:0.05x0.2@30", "stairs:0.04x0.15@-135",
                                         "rough:0.08", "rough:0", "slope:20+rough:0.04",
                                         "blocks:0.05", "patch:0.3x0.6", "soft:0.05"));

}  // namespace
}  // namespace pirouette
