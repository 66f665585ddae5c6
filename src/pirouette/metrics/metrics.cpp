#include "pirouette/metrics/metrics.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace pirouette {
namespace {

struct JsonWriter {
  nlohmann::ordered_json root;

  template <class T>
  void operator()(const T& value, const char* key, const char* /*unit*/, const char* /*meaning*/) {
    const std::string_view path = key;
    const auto dot = path.find('.');
    auto& entry = dot == path.npos
                      ? root[std::string(path)]
                      : root[std::string(path.substr(0, dot))][std::string(path.substr(dot + 1))];
    entry = convert(value);
  }

 private:
  template <class T>
  static nlohmann::ordered_json convert(const T& value) {
    return value;
  }
  static nlohmann::ordered_json convert(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
  }
  static nlohmann::ordered_json convert(const Number& value) {
    return value ? convert(*value) : nullptr;
  }
};

}  // namespace

std::string to_json(const Metrics& metrics) {
  JsonWriter writer;
  Metrics::fields(metrics, writer);
  constexpr int kIndent = 2;
  using Json = nlohmann::ordered_json;
  // A path that is not UTF-8 must not throw away the run.
  return writer.root.dump(kIndent, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string metrics_markdown() {
  std::string out = "| key | unit | meaning |\n|---|---|---|\n";
  const Metrics metrics;
  Metrics::fields(metrics,
                  [&](const auto&, const char* key, const char* unit, const char* meaning) {
                    out += std::string("| `") + key + "` | " + unit + " | " + meaning + " |\n";
                  });
  return out;
}

}  // namespace pirouette
