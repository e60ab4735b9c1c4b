// SPDX-License-Identifier: Apache-2.0
#include "adaptor/content_copy.h"

#include <cstring>

namespace volcontact::adaptor {
namespace {

// Rows that repeat for fewer bytes are kept one by one.
constexpr std::size_t kLeastRun = 256;

}  // namespace

void ContentCopy::keep(const std::byte* data, std::size_t size, std::size_t repeats) {
  if (size == 0) return;
  pieces_.push_back({size, repeats});
  bytes_.insert(bytes_.end(), data, data + (repeats > 0 ? repeats : size));
  ++arrays_.back().pieces;
}

void ContentCopy::add(const std::byte* data, std::size_t size, std::size_t width) {
  arrays_.push_back({size, 0});
  std::size_t begin = 0;  // of what is not in a piece yet
  for (std::size_t row = 0; row < size;) {
    std::size_t end = row + width;
    while (end < size && std::memcmp(data + row, data + end, width) == 0) end += width;
    if (end - row >= kLeastRun) {
      keep(data + begin, row - begin, 0);
      keep(data + row, end - row, width);
      begin = end;
    }
    row = end;
  }
  keep(data + begin, size - begin, 0);
}

void ContentCopy::Comparison::operator()(const std::byte* data, std::size_t size) noexcept {
  equal_ = equal_ && array_ < copy_.arrays_.size() && copy_.arrays_[array_].size == size;
  if (!equal_) return;
  const std::size_t last = piece_ + copy_.arrays_[array_++].pieces;
  for (; equal_ && piece_ < last; ++piece_) {
    const auto [length, repeats] = copy_.pieces_[piece_];
    const std::size_t kept = repeats > 0 ? repeats : length;
    equal_ = std::memcmp(data, copy_.bytes_.data() + kept_, kept) == 0 &&
             std::memcmp(data, data + kept, length - kept) == 0;
    kept_ += kept;
    data += length;
  }
}

}  // namespace volcontact::adaptor
