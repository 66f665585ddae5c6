#include "summary.hpp"

#include <cmath>
#include <cstdio>

namespace pirouette::app {
namespace {

/// `value` with `digits` significant digits and its unit; "-" when absent.
std::string shown(const Number& value, const char* unit, int digits = 3, double factor = 1.0) {
  if (!value || !std::isfinite(*value)) return "-";
  const double number = *value * factor;
  char text[64];
  // Fixed notation where it is short, so that columns of mm read as mm.
  const double size = std::abs(number);
  if (size != 0.0 && (size < 1e-4 || size >= 1e6)) {
    std::snprintf(text, sizeof text, "%.*e", digits - 1, number);
  } else {
    const int magnitude = size > 0.0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
    std::snprintf(text, sizeof text, "%.*f", std::max(0, digits - 1 - magnitude), number);
  }
  return *unit == '\0' ? text : std::string(text) + " " + unit;
}

/// `value` with `decimals` behind the point, and its unit; "-" when absent.
std::string fixed(const Number& value, const char* unit, int decimals) {
  if (!value || !std::isfinite(*value)) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f%s%s", decimals, *value, *unit == '\0' ? "" : " ", unit);
  return text;
}

std::string plain(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

class Table {
 public:
  void row(const std::string& label, const std::string& text) {
    constexpr std::size_t kLabelWidth = 20;
    out_ += "  " + label + std::string(kLabelWidth - std::min(label.size(), kLabelWidth - 1), ' ') +
            text + "\n";
  }
  void title(const std::string& text) { out_ += (out_.empty() ? "" : "\n") + text + "\n"; }
  const std::string& text() const { return out_; }

 private:
  std::string out_;
};

void add_context(Table& table, const RunContext& c) {
  table.title("Simulated");
  table.row("robot", c.robot);
  table.row("terrain", c.terrain + ", friction " + plain(c.friction) + ", torsional " +
                           plain(c.torsional_friction) + " m");
  table.row("controller", c.controller + ": " + c.foot_model + " foot, " + c.com_planner +
                              " CoM planner, " + c.reference + " reference, tracker " + c.tracker);
  table.row("estimator",
            c.estimator + ", " + c.sensors + " sensors, seed " + std::to_string(c.seed));
  table.row("gait", "period " + plain(c.period) + " s, duty " + plain(c.duty));
  std::string command = plain(c.yaw_rate) + " rad/s";
  if (c.velocity_x != 0.0 || c.velocity_y != 0.0) {
    command += ", " + plain(c.velocity_x) + " m/s forwards, " + plain(c.velocity_y) + " m/s left";
    if (c.yaw_rate != 0.0) {
      const double radius = std::hypot(c.velocity_x, c.velocity_y) / std::abs(c.yaw_rate);
      command += ": radius " + plain(radius) + " m";
    }
  }
  if (!c.path.empty()) {
    command = c.path + ", " + plain(std::hypot(c.velocity_x, c.velocity_y)) + " m/s along it";
  }
  table.row("command", command);
  table.row("duration", plain(c.duration_s) + " s");
}

void add_motion(Table& table, const Metrics& m) {
  const ComMetrics& com = m.com;
  table.title(m.fell          ? "Measured until the robot fell"
              : m.interrupted ? "Measured until it was interrupted"
                              : "Measured");
  if (m.fell) table.row("FELL", "after " + fixed(m.fall_time_s, "s", 2));
  if (!m.yaw_rate_mean) {
    table.row("motion", "none: it ended before the recording began");
    return;
  }
  table.row("turns", fixed(m.turns_done, "", 3));
  if (m.angle_error_deg) {
    const double turned = std::copysign(360.0 * m.turns_done, m.context.yaw_rate);
    table.row("angle", fixed(turned, "deg", 2) + " of " +
                           fixed(turned - *m.angle_error_deg, "deg", 2) + ", error " +
                           fixed(m.angle_error_deg, "deg", 2));
  }
  table.row("yaw rate",
            fixed(m.yaw_rate_mean, "rad/s", 4) +
                (m.yaw_rate_error ? ", error " + shown(m.yaw_rate_error, "%", 2, 100.0) : ""));
  if (com.distance_to_point_mean_mm) {
    table.row("distance to point", "mean " + shown(com.distance_to_point_mean_mm, "mm") +
                                       ", 95 % " + shown(com.distance_to_point_p95_mm, "mm") +
                                       ", largest " + shown(com.distance_to_point_max_mm, "mm"));
  }
  if (m.path.cross_track_mean_mm) {
    table.row("distance to path", "mean " + shown(m.path.cross_track_mean_mm, "mm") + ", largest " +
                                      shown(m.path.cross_track_max_mm, "mm"));
    table.row("along the path",
              "mean " + shown(m.path.along_track_mean_mm, "mm") + " from where it is due");
  }
  table.row("radius", "mean " + shown(com.radius_mean_mm, "mm") + ", largest " +
                          shown(com.radius_max_mm, "mm") + ", variance " +
                          shown(com.radius_variance_mm2, "mm^2"));
  table.row("range in 10 s", "x " + shown(com.peak_to_peak_x_mm, "mm") + ", y " +
                                 shown(com.peak_to_peak_y_mm, "mm"));
  table.row("drift", shown(com.drift_per_turn_mm, "mm per turn"));
  table.row("body-frame bias", shown(com.body_bias_mm_s, "mm/s"));
  table.row("roll", "mean " + shown(m.attitude.roll_mean, "mrad", 3, 1e3) + ", variance " +
                        shown(m.attitude.roll_variance, "rad^2"));
  table.row("pitch", "mean " + shown(m.attitude.pitch_mean, "mrad", 3, 1e3) + ", variance " +
                         shown(m.attitude.pitch_variance, "rad^2"));
  table.row("acceleration var.", "x " + shown(m.acceleration.x_variance, "(m/s^2)^2") + ", y " +
                                     shown(m.acceleration.y_variance, "(m/s^2)^2"));
  table.row("", "roll " + shown(m.acceleration.roll_variance, "(rad/s^2)^2") + ", pitch " +
                    shown(m.acceleration.pitch_variance, "(rad/s^2)^2"));
  if (m.contact.dropped_flags > 0) {
    table.row("contact flags", "of " + std::to_string(m.contact.dropped_flags) +
                                   " feet make no sense: the schedule stands in");
  }
  table.row("estimator error", shown(m.estimator.position_error_mm, "mm") + ", yaw " +
                                   shown(m.estimator.yaw_error_rad, "mrad", 3, 1e3));
}

void add_timing(Table& table, const TimingMetrics& t) {
  table.row("control tick", "median " + shown(t.tick_us_median, "us") + ", 99 % " +
                                shown(t.tick_us_p99, "us") + ", largest " +
                                shown(t.tick_us_max, "us"));
  table.row("", "MPC " + shown(t.mpc_us_median, "us") + ", WBC " + shown(t.wbc_us_median, "us") +
                    ", physics step " + shown(t.physics_step_us_median, "us"));
  table.row("speed", shown(t.real_time_factor, "x real time"));
}

}  // namespace

std::string summary(const Metrics& metrics) {
  Table table;
  add_context(table, metrics.context);
  add_motion(table, metrics);
  add_timing(table, metrics.timing);
  return table.text();
}

}  // namespace pirouette::app
