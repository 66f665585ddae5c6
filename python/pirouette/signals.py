"""What the figures derive from a trace. Arrays have one row a sample."""

import numpy as np

MM = 1e3
CUTOFF = 20.0  # Hz, of accelerations, as in the metrics
TURN = 2.0 * np.pi


def sample_rate(rows: np.ndarray) -> float:
    """Rows per second of simulated time."""
    return 1.0 / float(np.median(np.diff(rows["time"])))


def low_pass(x: np.ndarray, rate: float) -> np.ndarray:
    """Second-order Butterworth forwards and backwards, by its gain."""
    frequency = np.fft.rfftfreq(len(x), 1.0 / rate)
    return np.fft.irfft(np.fft.rfft(x) / (1.0 + (frequency / CUTOFF) ** 4), len(x))


def accelerations(rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Of the trunk: linear along world x, y (m/s^2) and angular about body x, y (rad/s^2), shape (n, 2)."""
    rate = sample_rate(rows)

    def derivative(x: np.ndarray) -> np.ndarray:
        return np.stack([low_pass(np.gradient(x[:, i]) * rate, rate) for i in range(2)], axis=1)

    return derivative(rows["true_base_velocity"]), derivative(rows["true_angular_velocity_B"])


def in_heading(vectors_W: np.ndarray, yaw: np.ndarray) -> np.ndarray:
    """Horizontal vectors of the world, shape (n, 2), in axes that turn with yaw (rad)."""
    c, s = np.cos(yaw), np.sin(yaw)
    x, y = vectors_W[:, 0], vectors_W[:, 1]
    return np.stack([c * x + s * y, c * y - s * x], axis=1)


def turn_average(rows: np.ndarray, xy: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Moving average of xy, shape (n, 2), over the time that one turn takes; with the times of
    the windows' middles. Empty when the robot turned less than once."""
    time, yaw = rows["time"], rows["true_rpy"][:, 2]
    turns = abs(yaw[-1] - yaw[0]) / TURN
    if turns < 1.0:
        return time[:0], xy[:0]
    window = min(len(rows), max(1, round(len(rows) / turns)))
    total = np.concatenate([np.zeros((1, 2)), np.cumsum(xy, axis=0)])
    mean = (total[window:] - total[:-window]) / window
    return time[window // 2 :][: len(mean)], mean
