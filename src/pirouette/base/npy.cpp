#include "pirouette/base/npy.hpp"

namespace pirouette {

std::string npy_header(const std::string& dtype, const std::string& shape, std::size_t spare) {
  std::string header = "{'descr': " + dtype + ", 'fortran_order': False, 'shape': " + shape +
                       ", }" + std::string(spare, ' ');
  constexpr std::size_t kPrefix = 10, kAlignment = 64;
  const std::size_t unpadded = kPrefix + header.size() + 1;
  header.append((kAlignment - unpadded % kAlignment) % kAlignment, ' ');
  header += '\n';

  std::string out = "\x93NUMPY";
  out += '\x01';
  out += '\x00';
  out += static_cast<char>(header.size() & 0xff);
  out += static_cast<char>(header.size() >> 8);
  return out + header;
}

}  // namespace pirouette
