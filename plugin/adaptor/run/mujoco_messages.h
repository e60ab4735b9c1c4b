// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csetjmp>
#include <string>

namespace volcontact::adaptor {

/// Where MuJoCo's errors and warnings go while a scene runs for another program: to the caller, as
/// text. MuJoCo itself would end the process, and write a file.
class MujocoMessages {
 public:
  /// Takes the place of MuJoCo's handlers, once for the process. On threads where no scene runs,
  /// those that were there before are called.
  static void install();

  /// Calls `function`; false where MuJoCo found an error, whose text is error(). `function` must
  /// hold no object with a destructor: MuJoCo's errors leave by longjmp.
  template <typename Function>
  static bool run(Function&& function) noexcept {
    std::jmp_buf here;
    std::jmp_buf* const outer = way_out();
    way_out() = &here;
    if (setjmp(here) == 0) {
      function();
      way_out() = outer;
      return true;
    }
    way_out() = outer;
    return false;
  }

  static const char* error() noexcept;

  /// Warnings of this thread since the last call, one a line.
  static std::string take_warnings();

 private:
  static std::jmp_buf*& way_out() noexcept;
  static void on_error(const char* text);
  static void on_warning(const char* text);
};

}  // namespace volcontact::adaptor
