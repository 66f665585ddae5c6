#include "pirouette/trial/trace_file.hpp"

namespace pirouette {

Result<NpyRowsFile> create_trace_file(const std::filesystem::path& path) {
  return NpyRowsFile::create(path, [](std::uint64_t rows) {
    const TickTrace tick;
    const PlantTruth truth;
    return npy_rows_header(TraceRow{tick, truth}, rows);
  });
}

std::string trace_markdown() {
  const TickTrace tick;
  const PlantTruth truth;
  return npy_rows_markdown(TraceRow{tick, truth});
}

}  // namespace pirouette
