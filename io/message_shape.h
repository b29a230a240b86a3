#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace rimod {

// Walks over encoded bytes field by field, so that counts are known to be good before the generated
// decoder, which trusts them, allocates for them. Once something does not fit, the rest is no-ops.
class ShapeCursor {
 public:
  ShapeCursor(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

  // Passes over fixed fields of so many bytes.
  void Skip(std::size_t num_bytes);
  // Reads a count field: int32, not negative, else the walk fails; then 0 is returned.
  std::int32_t Count();
  // Passes over an array of count elements, each of so many bytes.
  void SkipArray(std::int32_t count, std::size_t element_bytes);
  // Passes over a string: its length with the final zero, then the bytes, zero last and only there.
  void SkipString();

  bool ok() const { return error_ == nullptr; }
  bool at_end() const { return position_ == size_; }
  // Why the walk failed; null when it did not.
  const char* error() const { return error_; }

 private:
  void Fail(const char* error);

  const std::uint8_t* bytes_;
  std::size_t size_;
  std::size_t position_ = 0;
  const char* error_ = nullptr;
};

// Passes over all fields of an encoded message after its fingerprint. There is a specialisation for
// each type that is read from a channel, a log or a model file.
template <typename Message>
void WalkShape(ShapeCursor* cursor);

// Checks fingerprint and shape. Returns the cause, empty when the bytes are such a message and
// nothing else.
std::string CheckBytes(const void* bytes, std::size_t size, std::size_t max_size,
                       std::int64_t fingerprint, void (*walk)(ShapeCursor*));

}  // namespace rimod
