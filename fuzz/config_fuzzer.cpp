// --config FILE: what loads, dumps and loads again as the same configuration.
#include "input_file.hpp"
#include "pirouette/config/config_doc.hpp"
#include "pirouette/config/toml.hpp"

using pirouette::Config;
using pirouette::Result;
using pirouette::fuzz::InputFile;
using pirouette::fuzz::require;
using pirouette::fuzz::require_reasons;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const InputFile file(".toml");
  const Result<Config> config = pirouette::load_config({.file = file.write(data, size)});
  if (!config) {
    require_reasons(config);
    return 0;
  }
  const std::string dump = pirouette::dump_toml(config.value());
  const Result<Config> again = pirouette::load_config(
      {.file = file.write(reinterpret_cast<const std::uint8_t*>(dump.data()), dump.size())});
  require(static_cast<bool>(again), "a dump loads");
  require(pirouette::dump_toml(again.value()) == dump, "a dump loads as what it was");
  return 0;
}
