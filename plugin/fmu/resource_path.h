// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "volcontact/base/check.h"

namespace volcontact::fmu {

/// The path of a file: URI, percent signs undone, or a plain path as it is. Throws
/// std::invalid_argument on another kind of URI.
inline std::string path_from_uri(const char* uri) {
  require(uri != nullptr && *uri != '\0', "no resource location is given");
  std::string text(uri);
  const std::size_t scheme = text.find(':');
  // "C:\..." has a drive, not a scheme.
  if (scheme == std::string::npos || scheme < 2 || text[0] == '/') return text;
  require(text.compare(0, 5, "file:") == 0, "the resource location '" + text + "' is no file: URI");
  text.erase(0, 5);
  if (text.compare(0, 2, "//") == 0) text.erase(0, text.find('/', 2));  // an authority
  std::string path;
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'                 ? c - '0'
           : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10
                                                : -1;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_coded =
        text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0;
    path += is_coded ? static_cast<char>(16 * digit(text[i + 1]) + digit(text[i + 2])) : text[i];
    if (is_coded) i += 2;
  }
#if defined(_WIN32)
  if (path.size() > 2 && path[0] == '/' && path[2] == ':') path.erase(0, 1);
#endif
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

}  // namespace volcontact::fmu
