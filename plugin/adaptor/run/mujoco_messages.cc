// SPDX-License-Identifier: Apache-2.0
#include "adaptor/run/mujoco_messages.h"

#include <mujoco/mujoco.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <utility>

namespace volcontact::adaptor {
namespace {

using Handler = void (*)(const char*);
Handler error_before = nullptr, warning_before = nullptr;
constexpr std::size_t kLongest = 2000;

char* error_text() noexcept {
  thread_local char text[kLongest];
  return text;
}

// Of fixed size: what is written here may be left by longjmp.
struct Warnings {
  char text[kLongest];
  std::size_t length = 0;
};
Warnings& warnings() noexcept {
  thread_local Warnings all;
  return all;
}

}  // namespace

std::jmp_buf*& MujocoMessages::way_out() noexcept {
  thread_local std::jmp_buf* place = nullptr;
  return place;
}

void MujocoMessages::install() {
  static std::once_flag once;
  std::call_once(once, [] {
    error_before = std::exchange(mju_user_error, &MujocoMessages::on_error);
    warning_before = std::exchange(mju_user_warning, &MujocoMessages::on_warning);
  });
}

void MujocoMessages::on_error(const char* text) {
  if (way_out()) {
    std::snprintf(error_text(), kLongest, "%s", text);
    std::longjmp(*way_out(), 1);
  }
  if (error_before) return error_before(text);
  std::fprintf(stderr, "ERROR: %s\n", text);
  std::exit(EXIT_FAILURE);
}

void MujocoMessages::on_warning(const char* text) {
  if (!way_out()) {
    if (warning_before) return warning_before(text);
    std::fprintf(stderr, "WARNING: %s\n", text);
    return;
  }
  Warnings& all = warnings();
  const int written = std::snprintf(all.text + all.length, kLongest - all.length, "%s%s",
                                    all.length > 0 ? "\n" : "", text);
  if (written > 0 && all.length + static_cast<std::size_t>(written) < kLongest) {
    all.length += static_cast<std::size_t>(written);
  }
}

const char* MujocoMessages::error() noexcept { return error_text(); }

std::string MujocoMessages::take_warnings() {
  Warnings& all = warnings();
  std::string text(all.text, all.length);
  all.length = 0;
  return text;
}

}  // namespace volcontact::adaptor
