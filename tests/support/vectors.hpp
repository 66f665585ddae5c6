// Access to tests/data/vectors.json: numeric cases made with independent libraries.
#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "pirouette/base/legs.hpp"
#include "pirouette/base/math.hpp"
#include "pirouette/types/leg_geometry.hpp"

namespace pirouette::test {

/// One section of the file: its "cases" and the tolerance "tol" at which they hold.
inline const nlohmann::json& vectors(const std::string& section) {
  static const nlohmann::json all = [] {
    std::ifstream file(PIROUETTE_TEST_DATA_DIR "/vectors.json");
    return nlohmann::json::parse(file);
  }();
  return all.at(section);
}

template <int N>
Eigen::Matrix<double, N, 1> to_vector(const nlohmann::json& j) {
  Eigen::Matrix<double, N, 1> v;
  for (int i = 0; i < N; ++i) v[i] = j.at(i).get<double>();
  return v;
}

inline Vec2 to_vec2(const nlohmann::json& j) { return to_vector<2>(j); }
inline Vec3 to_vec3(const nlohmann::json& j) { return to_vector<3>(j); }

inline Mat3 to_mat3(const nlohmann::json& j) {
  Mat3 m;
  for (int row = 0; row < 3; ++row) m.row(row) = to_vec3(j.at(row)).transpose();
  return m;
}

inline Leg to_leg(const nlohmann::json& j) {
  const std::string given = j.get<std::string>();
  for (const Leg leg : kLegs) {
    if (name(leg) == given) return leg;
  }
  throw std::invalid_argument("no leg " + given);
}

/// The leg of the robot for which the vectors were made.
inline LegGeometry paper_leg(double side, double fore = 1.0) {
  const nlohmann::json& robot = vectors("robot");
  LegGeometry leg;
  leg.p_BH = {fore * robot.at("hip_x").get<double>(), side * robot.at("hip_y").get<double>(), 0.0};
  leg.abad_offset = side * robot.at("abad_offset").get<double>();
  leg.thigh = robot.at("L2").get<double>();
  leg.shank = robot.at("L3").get<double>();
  leg.foot_radius = robot.at("foot_radius").get<double>();
  return leg;
}

inline LegGeometry paper_leg(Leg leg) { return paper_leg(side_sign(leg), fore_sign(leg)); }

/// Largest absolute entry of a - b.
template <class A, class B>
double distance(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

}  // namespace pirouette::test
