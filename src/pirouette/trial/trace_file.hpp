// trace.npy: a NumPy structured array, one row per logged tick; `numpy.load` reads it.
#pragma once

#include <filesystem>
#include <string>

#include "pirouette/base/npy_rows_file.hpp"
#include "pirouette/base/result.hpp"
#include "pirouette/base/rotation.hpp"
#include "pirouette/types/plant_truth.hpp"
#include "pirouette/types/tick_trace.hpp"

namespace pirouette {

/// One row: what the controller computed and the true state at that moment.
struct TraceRow {
  const TickTrace& tick;    ///< of the controller
  const PlantTruth& truth;  ///< at the reading of that tick
  double true_yaw = 0.0;    ///< rad, unwrapped

  /// Calls visit(name, unit, meaning, value) for each column: those of the controller, then the
  /// truth's, whose names begin with "true_".
  template <class Visit>
  static void columns(const TraceRow& row, Visit&& visit);
};

/// A file for TraceRows. The error names the file that cannot be written.
Result<NpyRowsFile> create_trace_file(const std::filesystem::path& path);

/// Table of every column with its NumPy type, unit and meaning, in Markdown.
std::string trace_markdown();

template <class Visit>
void TraceRow::columns(const TraceRow& row, Visit&& visit) {
  TickTrace::columns(row.tick, visit);
  const PlantTruth& truth = row.truth;
  const RollPitchYaw rpy = rpy_from_rotation(truth.base.R_WB);
  visit("true_base_position", "m", "p_WB", truth.base.p_WB);
  visit("true_base_velocity", "m/s", "v_WB_W", truth.base.v_WB_W);
  visit("true_base_acceleration", "m/s^2", "a_WB_W, gravity taken out", truth.a_WB_W);
  visit("true_rpy", "rad", "roll, pitch, unwrapped yaw", Vec3(rpy.roll, rpy.pitch, row.true_yaw));
  visit("true_angular_velocity_B", "rad/s", "w_WB_B", truth.base.w_WB_B);
  visit("true_com_position", "m", "p_WG", truth.p_WG);
  visit("true_com_velocity", "m/s", "v_WG_W", truth.v_WG_W);
  visit("true_joint_position", "rad", "abad, hip, knee", truth.joint_position);
  visit("true_joint_velocity", "rad/s", "abad, hip, knee", truth.joint_velocity);
  visit("true_joint_torque", "N m", "applied by the motors", truth.joint_torque);
  visit("true_foot_position", "m", "p_WF, sphere centres", truth.p_WF);
  visit("true_foot_force", "N", "ground reaction, world axes", truth.f_W);
  visit("true_foot_slip", "m/s", "of the material point at the contact", truth.v_slip_W);
  visit("true_contact", "1", "foot touches the ground", truth.contact);
  visit("true_ground_height", "m", "of the terrain below the CoM", truth.ground_height);
}

}  // namespace pirouette
