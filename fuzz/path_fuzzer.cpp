// --path FILE.toml: what loads is finite everywhere.
#include <cmath>

#include "input_file.hpp"
#include "pirouette/config/path_file.hpp"
#include "pirouette/path/path.hpp"

using pirouette::Path;
using pirouette::PathFile;
using pirouette::PathSample;
using pirouette::Result;
using pirouette::fuzz::InputFile;
using pirouette::fuzz::require;
using pirouette::fuzz::require_reasons;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const InputFile file(".toml");
  const Result<PathFile> loaded = pirouette::load_path_file(file.write(data, size));
  if (!loaded) {
    require_reasons(loaded);
    return 0;
  }
  const Path& path = loaded.value().curve;
  constexpr int kSamples = 16;
  for (int i = 0; i <= kSamples; ++i) {
    const double s = path.length() * i / kSamples;
    const PathSample sample = path.at(s);
    require(
        sample.p.allFinite() && std::isfinite(sample.heading) && std::isfinite(sample.curvature),
        "a path is finite everywhere");
    require(std::isfinite(path.nearest(sample.p)), "every point has a nearest one");
  }
  return 0;
}
