// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace volcontact::adaptor {

/// A copy of some arrays, to tell later, in every step, whether they are still the same. Of rows
/// that repeat, as the friction of a thousand geoms, one is kept: the others are compared with
/// their neighbours, so that memory is read once and not twice.
class ContentCopy {
 public:
  /// Adds an array of `size` bytes in rows of `width`.
  void add(const std::byte* data, std::size_t size, std::size_t width);

  /// Compares arrays with those of a copy, in the order in which these were added.
  class Comparison {
   public:
    explicit Comparison(const ContentCopy& copy) : copy_(copy) {}
    void operator()(const std::byte* data, std::size_t size) noexcept;
    /// Whether all were the same, as many as were added.
    bool equal() const noexcept { return equal_ && array_ == copy_.arrays_.size(); }

   private:
    const ContentCopy& copy_;
    std::size_t array_ = 0, piece_ = 0, kept_ = 0;
    bool equal_ = true;
  };

 private:
  struct Array {
    std::size_t size, pieces;
  };
  struct Piece {
    std::size_t size;     // of the array [bytes]
    std::size_t repeats;  // bytes of the row that repeats; 0 where all are kept
  };
  void keep(const std::byte* data, std::size_t size, std::size_t repeats);

  std::vector<Array> arrays_;
  std::vector<Piece> pieces_;
  std::vector<std::byte> bytes_;
};

}  // namespace volcontact::adaptor
