#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace rimod {

// A frame taken apart, as the page does it.
struct DecodedFrame {
  nlohmann::json header;
  std::string lists;  // all bytes behind the header
  std::size_t begin = 0;
};

inline DecodedFrame DecodeFrame(const std::string& bytes) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes.at(i)); };
  const std::size_t size = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
  return {nlohmann::json::parse(bytes.substr(4, size)), bytes.substr(4 + size), 4 + size};
}

inline std::uint16_t Uint16At(const std::string& bytes, std::size_t index) {
  return static_cast<std::uint16_t>(static_cast<std::uint8_t>(bytes.at(2 * index)) |
                                    static_cast<std::uint8_t>(bytes.at(2 * index + 1)) << 8);
}

}  // namespace rimod
