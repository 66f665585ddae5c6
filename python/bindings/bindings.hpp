// The parts of the module pirouette._core.
#pragma once

#include <nanobind/nanobind.h>

namespace pirouette::python {

/// Readings and commands: the plain structs that cross the controller's border.
void define_values(nanobind::module_& module);
/// Controller and Simulation.
void define_loops(nanobind::module_& module);

}  // namespace pirouette::python
