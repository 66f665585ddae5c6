// Header of a NumPy array file, format version 1.0.
#pragma once

#include <bit>
#include <cstddef>
#include <string>

namespace pirouette {

static_assert(std::endian::native == std::endian::little,
              "numbers are written as they lie in memory");

/// Magic string, version 1.0, length and the header's dictionary, padded to a multiple of 64 bytes.
/// `dtype` and `shape` as Python writes them, such as "'<f4'" and "(3, 4)"; rows first. `spare`
/// spaces after them leave room for a longer shape.
std::string npy_header(const std::string& dtype, const std::string& shape, std::size_t spare = 0);

}  // namespace pirouette
