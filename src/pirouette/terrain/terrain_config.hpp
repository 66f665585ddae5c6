// Parameters of the terrain plane, the kind of ground and the foothold memory.
#pragma once

#include <array>

#include "pirouette/base/fields.hpp"

namespace pirouette {

/// Values of terrain.estimation.
enum class TerrainEstimation { kOff, kPlane };
template <>
struct EnumNames<TerrainEstimation> {
  static constexpr std::array<std::string_view, 2> kNames = {"off", "plane"};
};

/// Values of terrain.contact_normal.
enum class ContactNormal { kAuto, kPlane, kVertical };
template <>
struct EnumNames<ContactNormal> {
  static constexpr std::array<std::string_view, 3> kNames = {"auto", "plane", "vertical"};
};

/// Parameters `terrain.*`.
struct TerrainConfig {
  TerrainEstimation estimation = TerrainEstimation::kPlane;
  double stale_time_constant = 0.3;
  double stale_max_age = 1.0;
  double min_scatter = 2.5e-3;
  double ridge = 1e-3;
  double max_slope = 0.7;
  double filter_time = 0.3;
  ContactNormal contact_normal = ContactNormal::kAuto;
  double step_residual = 0.004;
  double step_residual_release = 0.002;
  bool memory = true;
  double edge_margin = 0.04;
  double min_step = 0.012;

  template <class Self, class Visit>
  static void fields(Self& s, Visit&& v) {
    v(s.estimation, "estimation", "off: the world is flat; plane: least-squares plane, E14.");
    v(s.stale_time_constant, "stale_time_constant", "s", Range{0.01, 10.0},
      "Weight of a lifted foot's last contact decays with this time constant.");
    v(s.stale_max_age, "stale_max_age", "s", Range{0.0, 20.0},
      "A contact older than this is left out of the plane.");
    v(s.min_scatter, "min_scatter", "m^2", Range{1e-6, 1.0},
      "Smallest eigenvalue of the contact scatter that determines a slope.");
    v(s.ridge, "ridge", "m^2", Range{0.0, 1.0}, "Pull of each slope towards its previous value.");
    v(s.max_slope, "max_slope", "1", Range{0.0, 2.0}, "Limit of the estimated gradient.");
    v(s.filter_time, "filter_time", "s", Range{0.0, 10.0},
      "Time constant of the plane's low-pass filter; 0: none.");
    v(s.contact_normal, "contact_normal",
      "Normal on which the feet roll. plane: the estimated plane's; vertical: as on treads; "
      "auto: vertical while the footholds do not fit a plane.");
    v(s.step_residual, "step_residual", "m", Range{0.0, 1.0},
      "The ground counts as stepped when the last footholds miss their plane by more, rms.");
    v(s.step_residual_release, "step_residual_release", "m", Range{0.0, 1.0},
      "It counts as even again when they miss it by less.");
    v(s.memory, "memory",
      "On stepped ground, remember footholds: keep feet off edges, expect the height met before.");
    v(s.edge_margin, "edge_margin", "m", Range{0.0, 0.2},
      "Least distance of a foothold from a remembered edge.");
    v(s.min_step, "min_step", "m", Range{0.001, 0.5},
      "Least height difference of neighbouring footholds that counts as an edge.");
  }
};

}  // namespace pirouette
