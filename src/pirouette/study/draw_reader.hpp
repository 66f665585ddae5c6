// Reads the tables [random] and [rows.random] of an experiment file; for this folder only.
#pragma once

#include <string>
#include <vector>

#include "pirouette/study/experiment_draw.hpp"
#include "pirouette/study/table_reader.hpp"

namespace pirouette {

/// The draws of the table `random` in `table`, in the order of the file; none when it is not there.
std::vector<ExperimentDraw> read_draws(const TableReader& reader, const toml::table& table,
                                       const std::string& prefix);

}  // namespace pirouette
