// Version of the library.
#pragma once

/// The library.
namespace pirouette {

/// Version of this library, such as "0.1.0".
const char* version();
/// Commit that the library was built from; "unknown" outside a git checkout.
const char* commit();

}  // namespace pirouette
