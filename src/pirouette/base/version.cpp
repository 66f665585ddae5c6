#include "pirouette/base/version.hpp"

#include "pirouette/version.hpp"

#ifndef PIROUETTE_COMMIT
#define PIROUETTE_COMMIT "unknown"
#endif

namespace pirouette {

const char* version() { return PIROUETTE_VERSION_STRING; }
const char* commit() { return PIROUETTE_COMMIT; }

}  // namespace pirouette
