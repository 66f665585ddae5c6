#include "pirouette/plant/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pirouette/base/rotation.hpp"
#include "pirouette/plant/scene.hpp"
#include "support/mini_cheetah.hpp"

namespace pirouette {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace)

constexpr double kMass = 8.912;  ///< kg

TEST(MiniCheetah, HasTheMassAndCentreOfMassOfItsProvenance) {
  const Terrain terrain(FlatGround{}, 0);
  const Scene scene = build_scene(WorldConfig{}, terrain, kRobot).value();
  EXPECT_NEAR(scene.model->body_subtreemass[scene.map.trunk_body], kMass, 1e-9);

  const PlantTruth truth = make_plant(ideal_config()).truth();
  const Vec3 p_BG = truth.base.R_WB.transpose() * (truth.p_WG - truth.base.p_WB);
  EXPECT_NEAR(p_BG.x(), -0.008, 0.001);  // shared figures are whole millimetres
  EXPECT_NEAR(p_BG.y(), 0.0, 1e-9);
  EXPECT_NEAR(p_BG.z(), -0.009, 0.001);
}

class RobotOnEveryTerrain : public testing::TestWithParam<const char*> {};

TEST_P(RobotOnEveryTerrain, StartsWithFeetTouchingBelowTheHipsAndTheComWhereAsked) {
  const Config config = ideal_config(GetParam());
  const Terrain terrain(parse_terrain(config.plant.terrain).value(), 1);
  for (const double yaw : {0.0, 0.7, 1.5708, -2.5}) {
    const Vec2 xy(0.31, -0.2);
    const PlantTruth truth = make_plant(config, xy, yaw).truth();
    EXPECT_NEAR((truth.p_WG.head<2>() - xy).norm(), 0.0, 1e-8);
    EXPECT_NEAR(rpy_from_rotation(truth.base.R_WB).yaw, yaw, 1e-9);
    EXPECT_NEAR(truth.base.R_WB.col(2).dot(terrain.normal()), 1.0, 1e-9);
    for (const Leg leg : kLegs) {
      const Vec3 p_BH(0.19 * fore_sign(leg), (0.049 + 0.062) * side_sign(leg), 0.0);
      const Vec3 p_WH = truth.base.p_WB + truth.base.R_WB * p_BH;
      // On stairs it is the nearest point where the foot touches no riser.
      const Vec2 below = terrain.beside_edges(p_WH.head<2>(), 0.0225);
      EXPECT_NEAR((truth.p_WF[leg].head<2>() - below).norm(), 0.0, 1e-8);
      EXPECT_NEAR(truth.p_WF[leg].z(), terrain.ball_height(truth.p_WF[leg].head<2>(), 0.0225),
                  1e-8);
      EXPECT_LT(truth.joint_position[leg].z(), 0.0);  // knees backward
    }
  }
}

TEST_P(RobotOnEveryTerrain, CarriesARobotWithStiffJoints) {
  Plant plant = make_plant(ideal_config(GetParam()));
  const Vec3 start = plant.truth().p_WG;
  stand(plant, 2.0);
  const PlantTruth& truth = plant.truth();
  EXPECT_NEAR((truth.p_WG - start).norm(), 0.0, 0.02);
  EXPECT_GT(truth.base.R_WB.col(2).dot(truth.ground_normal_W), 0.99);
  Vec3 ground_force = Vec3::Zero();
  for (const Vec3& f : truth.f_W) ground_force += f;
  // Nothing but the feet carries it; it may still sway a little.
  EXPECT_NEAR(ground_force.z(), kMass * kGravity, 0.02 * kMass * kGravity);
  EXPECT_NEAR(ground_force.head<2>().norm(), 0.0, 0.02 * kMass * kGravity);
}

// Blocks so low that none touches a shank.
INSTANTIATE_TEST_SUITE_P(Kinds, RobotOnEveryTerrain,
                         testing::Values("flat", "slope:10", "slope:25", "stairs:0.03x0.20",
                                         "stairs:0.1x0.3", "stairs:0.03x0.20@30", "rough:0.04",
                                         "slope:10+rough:0.02", "blocks:0.02", "patch:0.3x0.6",
                                         "soft:0.04"));

TEST(Start, SucceedsWhereverTheRobotStandsOnBlocks) {
  Config config = ideal_config("blocks:0.05");
  for (config.run.seed = 1; config.run.seed <= 60; ++config.run.seed) {
    EXPECT_TRUE(create_plant(config, kRobot).ok()) << config.run.seed;
  }
}

TEST(Start, PutsTheComAtTheConfiguredHeight) {
  for (const double height : {0.2, 0.27, 0.33}) {
    Config config = ideal_config("slope:20");
    config.body.height = height;
    const PlantTruth truth = make_plant(config, Vec2(0.4, 0.1), 1.0).truth();
    EXPECT_NEAR(truth.p_WG.z() - truth.ground_height, height, 1e-8);
  }
}

TEST(Start, NamesWhatItCannotDo) {
  Config config = ideal_config("slope:99");
  config.plant.timestep = 0.0015;
  config.plant.command_latency = 0.001;
  const Result<Plant> bad = create_plant(config, kRobot);
  ASSERT_FALSE(bad.ok());
  ASSERT_EQ(bad.errors().size(), 3U);  // terrain, timestep and latency, all at once
  EXPECT_EQ(bad.errors()[0].key, "plant.terrain");
  EXPECT_EQ(bad.errors()[1].key, "plant.timestep");
  EXPECT_EQ(bad.errors()[2].key, "plant.command_latency");

  config = ideal_config();
  config.body.height = 0.6;
  EXPECT_EQ(create_plant(config, kRobot).errors().front().key, "body.height");
  config = ideal_config("rough:0.04");
  EXPECT_EQ(create_plant(config, kRobot, Vec2(4.5, 0.0)).errors().front().key, "run.start_offset");
  EXPECT_EQ(create_plant(ideal_config(), "nowhere.xml").errors().front().file, "nowhere.xml");
}

TEST(Motors, ApplyFeedForwardAndFeedbackFromTheTrueJointState) {
  Plant plant = make_plant(ideal_config());
  JointCommand command;
  command[Leg::kFL].tau = Vec3(1.0, -2.0, 3.0);
  command[Leg::kRR].q = plant.truth().joint_position[Leg::kRR] + Vec3(0.1, 0.0, -0.1);
  command[Leg::kRR].kp.setConstant(10.0);
  command[Leg::kRR].kd.setConstant(0.5);
  command[Leg::kRR].dq.setConstant(1.0);
  plant.advance(command);
  const PlantTruth& truth = plant.truth();
  EXPECT_EQ(truth.joint_torque[Leg::kFR], Vec3::Zero());
  EXPECT_EQ(truth.joint_torque[Leg::kFL], Vec3(1.0, -2.0, 3.0));
  const Vec3 expected = 10.0 * (command[Leg::kRR].q - truth.joint_position[Leg::kRR]) +
                        0.5 * (Vec3::Ones() - truth.joint_velocity[Leg::kRR]);
  EXPECT_NEAR((truth.joint_torque[Leg::kRR] - expected).norm(), 0.0, 1e-12);
}

TEST(Motors, StayWithinTheirLimitsAndScaleBeforeThem) {
  Config config = ideal_config();
  config.plant.torque_scale = 0.5;
  Plant plant = make_plant(config);
  JointCommand command;
  command[Leg::kFR].tau = Vec3(100.0, -100.0, 100.0);
  command[Leg::kRL].tau = Vec3(4.0, -6.0, 8.0);
  plant.advance(command);
  EXPECT_EQ(plant.truth().joint_torque[Leg::kFR], Vec3(18.0, -18.0, 28.0));
  EXPECT_EQ(plant.truth().joint_torque[Leg::kRL], Vec3(2.0, -3.0, 4.0));
}

TEST(Motors, ReceiveACommandExactlyOneLatencyLate) {
  Config config = ideal_config();
  config.plant.timestep = 0.001;
  config.plant.command_latency = 0.005;  // two and a half ticks
  Plant delayed = make_plant(config);
  JointCommand limp, command;
  command[Leg::kFR].tau = Vec3(1.0, 0.0, 0.0);
  delayed.advance(limp);
  delayed.advance(command);  // given at 2 ms, felt from 7 ms on
  std::vector<double> torque;
  for (int i = 0; i < 4; ++i) {
    torque.push_back(delayed.truth().joint_torque[Leg::kFR].x());
    delayed.advance(limp);
  }
  // In force during the last physics step before 4, 6, 8 and 10 ms.
  EXPECT_EQ(torque, (std::vector<double>{0.0, 0.0, 1.0, 0.0}));

  config.plant.command_latency = 0.0;
  Plant prompt = make_plant(config);
  prompt.advance(limp);
  prompt.advance(command);
  EXPECT_EQ(prompt.truth().joint_torque[Leg::kFR].x(), 1.0);
}

TEST(Motors, ActTheSameLateAsEarly) {
  // With limp joints before it, a late command moves the joints as a prompt one does, one latency
  // later.
  Config config = ideal_config();
  Plant prompt = make_plant(config);
  config.plant.command_latency = 0.004;
  Plant late = make_plant(config);
  const JointCommand limp;
  JointCommand command;
  command[Leg::kFR].tau = Vec3(2.0, 0.0, 0.0);
  for (int i = 0; i < 2; ++i) prompt.advance(limp);
  for (int i = 0; i < 5; ++i) {
    prompt.advance(command);
    late.advance(command);
  }
  for (int i = 0; i < 2; ++i) late.advance(command);
  EXPECT_EQ(prompt.truth().joint_position[Leg::kFR], late.truth().joint_position[Leg::kFR]);
}

TEST(Truth, IsConsistentWithItsOwnDerivatives) {
  Config config = ideal_config();
  config.control.rate = 1.0 / config.plant.timestep;
  Plant plant = make_plant(config);
  const JointCommand command = hold(plant.truth());
  for (int i = 0; i < 500; ++i) plant.advance(command);
  plant.push(Vec3(0.3, -0.2, 0.0));
  for (int i = 0; i < 50; ++i) {
    const PlantTruth before = plant.truth();
    plant.advance(command);
    const PlantTruth& after = plant.truth();
    // The integrator moves positions by the new velocity, so that these hold to rounding;
    const Vec3 base_velocity = (after.base.p_WB - before.base.p_WB) / config.plant.timestep;
    EXPECT_NEAR((base_velocity - after.base.v_WB_W).norm(), 0.0, 1e-9);
    const Vec3 turned =
        log_so3(before.base.R_WB.transpose() * after.base.R_WB) / config.plant.timestep;
    EXPECT_NEAR((turned - after.base.w_WB_B).norm(), 0.0, 1e-9);
    // the CoM depends on them to first order in the step.
    const Vec3 com_velocity = (after.p_WG - before.p_WG) / config.plant.timestep;
    EXPECT_NEAR((com_velocity - after.v_WG_W).norm(), 0.0, 1e-3);
  }
}

TEST(Truth, HoldsNewtonsLawForTheWholeRobot) {
  Config config = ideal_config();
  config.control.rate = 1000.0;  // one physics step a tick
  Plant plant = make_plant(config);
  const JointCommand command = hold(plant.truth());
  for (int i = 0; i < 500; ++i) plant.advance(command);
  plant.push(Vec3(0.2, 0.1, 0.1));
  for (int i = 0; i < 30; ++i) {
    const PlantTruth before = plant.truth();
    plant.advance(command);
    const Vec3 acceleration = (plant.truth().v_WG_W - before.v_WG_W) / 0.001;
    Vec3 force = Vec3(0.0, 0.0, -kMass * kGravity);
    for (const Vec3& f : before.f_W) force += f;
    // Implicit joint damping and the step's own error; the forces are of the order of 100 N.
    EXPECT_NEAR((kMass * acceleration - force).norm(), 0.0, 3.0) << i;
  }
}

TEST(Truth, ShowsSlipOfTheMaterialPointOnly) {
  Plant plant = make_plant(ideal_config());
  stand(plant, 0.5);
  for (const Vec3& slip : plant.truth().v_slip_W) EXPECT_LT(slip.norm(), 1e-3);
  plant.push(Vec3(0.5, 0.0, 0.0));  // the whole robot, feet included, moves at once
  for (const Leg leg : kLegs)
    EXPECT_NEAR((plant.truth().v_slip_W[leg] - Vec3(0.5, 0.0, 0.0)).norm(), 0.0, 2e-3);
}

TEST(Truth, IsNoNumberAfterTheSimulationBrokeDown) {
  Plant plant = make_plant(ideal_config());
  plant.push(Vec3(1e9, 0.0, 0.0));
  plant.advance(JointCommand{});
  EXPECT_FALSE(plant.truth().p_WG.allFinite());
  EXPECT_FALSE(plant.sense().specific_force_B.allFinite());
  const double time = plant.truth().time;
  plant.advance(JointCommand{});
  EXPECT_FALSE(plant.truth().base.R_WB.allFinite());
  EXPECT_GT(plant.truth().time, time);

  Plant other = make_plant(ideal_config());
  JointCommand not_finite;
  not_finite[Leg::kRR].tau.x() = std::nan("");
  other.advance(not_finite);
  EXPECT_FALSE(other.truth().p_WG.allFinite());
}

TEST(Truth, IsTheSameInEveryRun) {
  const auto run = [] {
    Plant plant = make_plant(ideal_config("rough:0.04"), Vec2(0.1, 0.2), 0.3);
    stand(plant, 0.2);
    plant.push(Vec3(0.4, 0.3, 0.0));
    stand(plant, 0.5);
    return plant.truth();
  };
  EXPECT_EQ(run().p_WG, run().p_WG);
  EXPECT_EQ(run().f_W[Leg::kRL], run().f_W[Leg::kRL]);
}

TEST(Contacts, HaveExactlyTheConfiguredFriction) {
  WorldConfig config;
  config.friction = 0.37;
  config.torsional_friction = 0.0021;
  config.rolling_friction = 0.00013;
  for (const char* text : {"flat", "slope:10", "stairs:0.03x0.2", "rough:0.04"}) {
    const Terrain terrain(parse_terrain(text).value(), 1);
    const Scene scene = build_scene(config, terrain, kRobot).value();
    const DataPtr data(mj_makeData(scene.model.get()));
    // Straight legs, with the feet half a radius in the ground.
    data->qpos[scene.map.trunk_qpos + 2] = 0.415 + 0.011;
    mj_forward(scene.model.get(), data.get());
    int feet = 0;
    for (int i = 0; i < data->ncon; ++i) {
      const mjContact& contact = data->contact[i];
      for (const LegMap& leg : scene.map.legs) {
        if (contact.geom[0] != leg.foot_geom && contact.geom[1] != leg.foot_geom) continue;
        ++feet;
        EXPECT_EQ(contact.dim, 6);
        EXPECT_EQ(contact.friction[0], 0.37);
        EXPECT_EQ(contact.friction[1], 0.37);
        EXPECT_EQ(contact.friction[2], 0.0021);
        EXPECT_EQ(contact.friction[3], 0.00013);
        EXPECT_EQ(contact.friction[4], 0.00013);
      }
    }
    EXPECT_GE(feet, 2) << text;
  }
}

TEST(Contacts, SlideBeyondTheFrictionConeAndHoldWithinIt) {
  const auto slid = [](double friction) {
    Config config = ideal_config("slope:20");  // tan 20 deg = 0.364
    config.plant.friction = friction;
    Plant plant = make_plant(config);
    const double start = plant.truth().p_WG.x();
    stand(plant, 1.0);
    return start - plant.truth().p_WG.x();  // downhill
  };
  // On a frictional slope: a = g (sin - mu cos) for 1 s; 0.5 m to 10 % for the settling.
  const double expected = 0.5 * kGravity *
                          (std::sin(radians(20.0)) - 0.25 * std::cos(radians(20.0))) *
                          std::cos(radians(20.0));
  EXPECT_NEAR(slid(0.25), expected, 0.1 * expected);
  EXPECT_LT(slid(0.5), 0.02);
}

TEST(Contacts, SlideFurtherOnThePatch) {
  const auto slid = [](double x) {
    Plant plant = make_plant(ideal_config("patch:0.1x2"), Vec2(x, 0.0));
    stand(plant, 0.5);
    const Vec3 start = plant.truth().p_WG;
    plant.push(Vec3(0.0, 0.5, 0.0));
    stand(plant, 1.0);
    return (plant.truth().p_WG - start).y();
  };
  // Sliding stops after v^2 / (2 mu g); 15 % for how the legs give.
  const double expected = square(0.5) / (2.0 * 0.1 * kGravity);
  EXPECT_NEAR(slid(1.0), expected, 0.15 * expected);
  EXPECT_LT(slid(-1.0), 0.5 * expected);
}

TEST(Contacts, SinkFurtherIntoSoftGround) {
  const auto sunk = [](const char* terrain) {
    Config config = ideal_config(terrain);
    config.plant.contact_time_constant = 0.03;
    Plant plant = make_plant(config);
    stand(plant, 2.0);
    double height = 0.0;
    for (const Vec3& p_WF : plant.truth().p_WF) height += p_WF.z() / kLegCount;
    return 0.0225 - height;
  };
  // The depth under a load grows with the square of the time constant.
  EXPECT_NEAR(sunk("soft:0.06") / sunk("soft:0.03"), 4.0, 0.4);
  EXPECT_EQ(sunk("soft:0.03"), sunk("flat"));
}

TEST(Scene, LeavesOutAFloorOfTheRobotsOwn) {
  const std::string path = testing::TempDir() + "with_floor.xml";
  mjSpec* spec = mj_parseXML(kRobot.c_str(), nullptr, nullptr, 0);
  mjsGeom* floor = mjs_addGeom(mjs_findBody(spec, "world"), nullptr);
  floor->type = mjGEOM_PLANE;
  floor->size[2] = 1.0;
  floor->pos[2] = 1.0;
  const SpecPtr owner(spec);
  ASSERT_NE(ModelPtr(mj_compile(spec, nullptr)), nullptr);
  ASSERT_EQ(mj_saveXML(spec, path.c_str(), nullptr, 0), 0);
  const Scene scene = build_scene(WorldConfig{}, Terrain(FlatGround{}, 0), path).value();
  int fixed = 0;
  for (int g = 0; g < scene.model->ngeom; ++g) fixed += scene.model->geom_bodyid[g] == 0;
  EXPECT_EQ(fixed, 1);  // the terrain's
}

TEST(Plant, TimesItsPhysicsSteps) {
  Plant plant = make_plant(ideal_config());
  EXPECT_EQ(plant.physics_step_us_median(), 0.0);
  stand(plant, 0.1);
  EXPECT_GT(plant.physics_step_us_median(), 0.0);
}

}  // namespace
}  // namespace pirouette
