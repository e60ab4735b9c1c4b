// SPDX-License-Identifier: Apache-2.0
#include "adaptor/content_copy.h"

#include <gtest/gtest.h>

#include <random>

namespace volcontact::adaptor::content_copy_test {
namespace {

using Bytes = std::vector<std::byte>;
struct Rows {
  Bytes bytes;
  std::size_t width;
};

bool is_same(const ContentCopy& copy, const std::vector<Rows>& arrays) {
  ContentCopy::Comparison compare(copy);
  for (const Rows& rows : arrays) compare(rows.bytes.data(), rows.bytes.size());
  return compare.equal();
}

// Rows of some width, of which some repeat for long, some for short, some not at all.
Rows some_rows(std::mt19937& random, std::size_t width) {
  Rows rows{{}, width};
  for (int run = 0; run < 12; ++run) {
    Bytes row(width);
    for (std::byte& byte : row) byte = static_cast<std::byte>(random() % 3);
    const std::size_t count = run % 3 == 0 ? 1 + random() % 200 : 1 + random() % 3;
    for (std::size_t i = 0; i < count; ++i) {
      rows.bytes.insert(rows.bytes.end(), row.begin(), row.end());
    }
  }
  return rows;
}

TEST(ContentCopy, NoticesEachByteThatChanges) {
  std::mt19937 random(3);
  std::vector<Rows> arrays;
  for (const std::size_t width : {1, 4, 24, 40}) arrays.push_back(some_rows(random, width));
  arrays.push_back({Bytes(24 * 500, std::byte{7}), 24});
  arrays.push_back({Bytes(3, std::byte{1}), 1});
  ContentCopy copy;
  for (const Rows& rows : arrays) copy.add(rows.bytes.data(), rows.bytes.size(), rows.width);
  ASSERT_TRUE(is_same(copy, arrays));
  for (Rows& rows : arrays) {
    for (std::byte& byte : rows.bytes) {
      byte ^= std::byte{8};
      ASSERT_FALSE(is_same(copy, arrays));
      byte ^= std::byte{8};
    }
  }
  EXPECT_TRUE(is_same(copy, arrays));
}

// All rows may change in the same way.
TEST(ContentCopy, NoticesRowsThatStillRepeat) {
  std::vector<Rows> arrays{{Bytes(1000, std::byte{1}), 1}};
  ContentCopy copy;
  copy.add(arrays[0].bytes.data(), 1000, 1);
  std::fill(arrays[0].bytes.begin(), arrays[0].bytes.end(), std::byte{2});
  EXPECT_FALSE(is_same(copy, arrays));
}

TEST(ContentCopy, NoticesArraysThatAreLongerShorterOrFewer) {
  const std::vector<Rows> arrays{{Bytes(400, std::byte{1}), 1}, {Bytes(8, std::byte{2}), 8}};
  ContentCopy copy;
  for (const Rows& rows : arrays) copy.add(rows.bytes.data(), rows.bytes.size(), rows.width);
  std::vector<Rows> others = arrays;
  others[0].bytes.push_back(std::byte{1});
  EXPECT_FALSE(is_same(copy, others));
  others[0].bytes.resize(399);
  EXPECT_FALSE(is_same(copy, others));
  others = arrays;
  others.pop_back();
  EXPECT_FALSE(is_same(copy, others));
  others = arrays;
  others.push_back(arrays[0]);
  EXPECT_FALSE(is_same(copy, others));
}

}  // namespace
}  // namespace volcontact::adaptor::content_copy_test
