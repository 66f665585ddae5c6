// What kind of ground the last footholds make.
#pragma once

namespace pirouette {

struct GroundEstimate {
  bool known = false;        ///< every foot has stood often enough for a verdict
  bool stepped = false;      ///< the footholds do not fit a plane: stairs, blocks, rough ground
  double residual = 0.0;     ///< m, rms of the last footholds about their plane
  double step_height = 0.0;  ///< m, range of the footholds' heights about that plane
};

}  // namespace pirouette
