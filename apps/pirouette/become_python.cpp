#include "become_python.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "pirouette/config/data_folders.hpp"

namespace pirouette::app {

void become_python(const std::string& module, char** arguments) {
  namespace fs = std::filesystem;
  ::execvp(arguments[0], arguments);
  const fs::path root = data_dir();
  const fs::path package = root / "python" / "pirouette";
  std::string python = (root / ".venv" / "bin" / "python").string();
  if (!fs::exists(python)) return;
  if (!fs::exists(package / module / "__main__.py") && !fs::exists(package / (module + ".py")))
    return;
  ::setenv("PYTHONPATH", (root / "python").c_str(), 1);
  std::string flag = "-m", name = "pirouette." + module;
  std::vector<char*> line = {python.data(), flag.data(), name.data()};
  while (*++arguments != nullptr) line.push_back(*arguments);
  line.push_back(nullptr);
  ::execv(python.c_str(), line.data());
}

}  // namespace pirouette::app
