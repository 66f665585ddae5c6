// Table of all trials of an experiment: one line each, with every metric.
#pragma once

#include <string>

#include "pirouette/study/sweep.hpp"

namespace pirouette {

/// Name of the file.
inline constexpr const char* kTrialTable = "table.csv";

/// CSV in the order of the experiment: trial (number from 0), key (trial_key()), row, a column for
/// each axis and each parameter that is drawn, seed, and every metric of metric_names(); an absent
/// value is an empty cell. Numbers
/// read back as the same doubles. The same for any number of jobs, shards and interruptions.
std::string trial_table(const Experiment& experiment, const SweepResult& result);

}  // namespace pirouette
