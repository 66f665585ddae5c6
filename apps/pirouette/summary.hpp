// The table a run prints for people.
#pragma once

#include <string>

#include "pirouette/metrics/metrics.hpp"

namespace pirouette::app {

std::string summary(const Metrics& metrics);

}  // namespace pirouette::app
