"""What [Zhu21] prints, section 4 and figures 6 to 8, with the keys of metrics.json.

The attitude variances are printed in rad; rad^2 is meant.
"""

PRINTED_RADII = {"MIT": 27.9, "MIT+FKM": 14.0, "ASC": 11.2}  # mm, simulated, figure 6A

PRINTED = {
    "MIT simulated": {
        "com.radius_mean_mm": 27.9,
        "com.radius_variance_mm2": 0.57,
        "com.peak_to_peak_x_mm": 34.9,
        "com.peak_to_peak_y_mm": 19.6,
        "acceleration.x_variance": 0.151,
        "acceleration.y_variance": 0.142,
        "acceleration.roll_variance": 3.3e-3,
        "acceleration.pitch_variance": 8.7e-2,
    },
    "MIT+FKM simulated": {
        "com.radius_mean_mm": 14.0,
        "com.radius_variance_mm2": 0.43,
    },
    "ASC simulated": {
        "com.radius_mean_mm": 11.2,
        "com.radius_variance_mm2": 0.31,
        "com.peak_to_peak_x_mm": 6.2,
        "com.peak_to_peak_y_mm": 7.1,
        "acceleration.x_variance": 8.48e-2,
        "acceleration.y_variance": 8.69e-2,
        "acceleration.roll_variance": 1.1e-3,
        "acceleration.pitch_variance": 1.3e-3,
    },
    "ASC robot": {
        "com.radius_mean_mm": 38.4,
        "com.radius_variance_mm2": 56.0,
        "com.peak_to_peak_x_mm": 12.5,
        "com.peak_to_peak_y_mm": 10.6,
        "attitude.roll_mean": -1.35e-2,
        "attitude.roll_variance": 1.17e-4,
        "attitude.pitch_mean": 1.77e-3,
        "attitude.pitch_variance": 1e-4,
        "acceleration.x_variance": 0.784,
        "acceleration.roll_variance": 0.088,
        "acceleration.pitch_variance": 0.084,
    },
}
