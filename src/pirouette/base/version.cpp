#include "pirouette/base/version.hpp"

#ifndef PIROUETTE_VERSION
#define PIROUETTE_VERSION "unknown"
#endif
#ifndef PIROUETTE_COMMIT
#define PIROUETTE_COMMIT "unknown"
#endif

namespace pirouette {

const char* version() { return PIROUETTE_VERSION; }
const char* commit() { return PIROUETTE_COMMIT; }

}  // namespace pirouette
