// SPDX-License-Identifier: Apache-2.0
#include "c_api/guarded.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <sstream>
#include <stdexcept>

namespace volcontact::c_api {
namespace {

// Of fixed size, so that a message about lack of memory needs none.
thread_local char last_error[2048] = "";

}  // namespace

int fail(int code, const char* text) noexcept {
  const std::size_t length = std::min(std::strlen(text), sizeof last_error - 1);
  std::memcpy(last_error, text, length);
  last_error[length] = '\0';
  return code;
}

int fail_by_exception() noexcept {
  try {
    throw;
  } catch (const std::invalid_argument& error) {
    return fail(VC_ERROR_ARGUMENT, error.what());
  } catch (const std::bad_alloc&) {
    return fail(VC_ERROR_MEMORY, "out of memory");
  } catch (const std::exception& error) {
    return fail(VC_ERROR_INTERNAL, error.what());
  } catch (...) {
    return fail(VC_ERROR_INTERNAL, "an exception of unknown type");
  }
}

void require_given(const void* pointer, const char* function, const char* argument) {
  if (pointer) return;
  throw std::invalid_argument(std::string(function) + ": " + argument + " is null");
}

Pose pose_from(const double* matrix, const char* name) {
  if (!matrix) return {};
  constexpr double kOrthonormal = 1e-6;  // numbers of single precision are welcome
  const auto m = Matrix<4, 4>::from_rows(matrix);
  if (!m.allFinite()) {
    throw std::invalid_argument(std::string(name) + ": the pose has a number that is not finite");
  }
  const Pose pose{m.block<3, 3>(0, 0), m.col(3).head<3>()};
  const double skewed = (pose.rotation.transpose() * pose.rotation - Mat3::Identity()).norm();
  if (skewed > kOrthonormal || pose.rotation.determinant() < 0.0) {
    std::ostringstream message;
    message << name << ": the upper left 3x3 block is no rotation (determinant "
            << pose.rotation.determinant() << ", |R^T R - 1| = " << skewed << ", allowed "
            << kOrthonormal << "); poses are row-major 4x4 matrices";
    throw std::invalid_argument(message.str());
  }
  if (m.row(3) != Vector<4>::Unit(3)) {
    throw std::invalid_argument(
        std::string(name) +
        ": the last row of a pose must be 0 0 0 1; poses are row-major 4x4 matrices");
  }
  return pose;
}

void copy_pose(const Pose& pose, double* matrix) noexcept {
  auto m = Matrix<4, 4>::Identity();
  m.set_block(0, 0, pose.rotation);
  pose.translation.to(m.col(3).data());
  m.to_rows(matrix);
}

Twist twist_from(const double* numbers, const char* name) {
  const auto v = Vector<6>::from(numbers);
  if (!v.allFinite()) {
    throw std::invalid_argument(std::string(name) + ": the twist has a number that is not finite");
  }
  return {v.head<3>(), v.tail<3>()};
}

const char* message() noexcept { return last_error; }

int copy_text(const std::string& text, char* buffer, int capacity) noexcept {
  if (buffer && capacity > 0) {
    const std::size_t count = std::min(text.size(), static_cast<std::size_t>(capacity - 1));
    std::memcpy(buffer, text.data(), count);
    buffer[count] = '\0';
  }
  return static_cast<int>(text.size());
}

}  // namespace volcontact::c_api

using namespace volcontact::c_api;

extern "C" {

int vc_version(void) { return VC_VERSION; }

int vc_check_version(int version_of_header) {
  constexpr int kPatches = 100;
  if (version_of_header / kPatches == VC_VERSION / kPatches) return 0;
  return guarded([&] {
    return fail(VC_ERROR_VERSION,
                ("the program was compiled with the header of version " +
                 std::to_string(version_of_header) + " and the library has " +
                 std::to_string(VC_VERSION) + "; compile it with the library's own volcontact.h")
                    .c_str());
  });
}

int vc_check_layout(int version_of_header, int motion_size, int site_size, int result_size,
                    int tangent_size) {
  const int code = vc_check_version(version_of_header);
  if (code != 0) return code;
  const struct {
    const char* name;
    int theirs, ours;
  } records[] = {{"vc_motion", motion_size, sizeof(vc_motion)},
                 {"vc_site", site_size, sizeof(vc_site)},
                 {"vc_result", result_size, sizeof(vc_result)},
                 {"vc_tangent", tangent_size, sizeof(vc_tangent)}};
  for (const auto& record : records) {
    if (record.theirs == record.ours) continue;
    return guarded([&] {
      return fail(VC_ERROR_VERSION,
                  (std::string("the ") + record.name + " of the program has " +
                   std::to_string(record.theirs) + " bytes and that of the library " +
                   std::to_string(record.ours) +
                   "; compile the program with the library's own volcontact.h")
                      .c_str());
    });
  }
  return 0;
}

const char* vc_error(void) { return volcontact::c_api::message(); }

}  // extern "C"
