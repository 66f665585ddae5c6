// Programs of the Python package.
#pragma once

#include <string>

namespace pirouette::app {

/// Becomes the program `arguments[0]` on PATH, else the module pirouette.`module` of the source
/// tree's Python package, with the arguments behind it; `arguments` ends with nullptr. Returns only
/// when there is neither.
void become_python(const std::string& module, char** arguments);

}  // namespace pirouette::app
