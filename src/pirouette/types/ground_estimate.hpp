// Kind of ground, from the last footholds.
#pragma once

namespace pirouette {

/// Whether the ground is stepped. docs/terrain.md#discriminator
struct GroundEstimate {
  bool known = false;        ///< every foot has stood often enough for the estimate
  bool stepped = false;      ///< the footholds do not fit a plane: stairs, blocks, rough ground
  double residual = 0.0;     ///< m, rms of the last footholds about their plane
  double step_height = 0.0;  ///< m, range of the footholds' heights about that plane
};

}  // namespace pirouette
