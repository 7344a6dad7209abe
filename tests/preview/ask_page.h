// Asks a preview page in a headless Chromium what it shows (baker/preview/player.js: #test=...).
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/assets.h"

namespace ft::test {

/// hash: "frame=107&test=sheet:0,57". Null where the page did not answer.
inline nlohmann::json ask_page(const std::filesystem::path& page, const std::string& hash) {
  const ScratchFolder profile;
  const std::string command =
      "timeout 120 chromium --headless --no-sandbox --disable-gpu --use-gl=angle --use-angle=swiftshader "
      "--enable-unsafe-swiftshader --no-first-run --disable-background-networking --disable-component-update "
      "--disable-sync --user-data-dir=" +
      profile.path().string() + " --virtual-time-budget=20000 --dump-dom 'file://" + page.string() + "#" + hash +
      "' 2>/dev/null";
  std::string dom;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 65536> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) dom.append(buffer.data(), n);
  pclose(pipe);
  const std::string open = "<pre id=\"test-answer\">";
  const std::size_t begin = dom.find(open);
  EXPECT_NE(begin, std::string::npos) << "the page did not answer; " << dom.size() << " bytes came";
  if (begin == std::string::npos) return {};
  const std::size_t end = dom.find("</pre>", begin);
  return nlohmann::json::parse(dom.substr(begin + open.size(), end - begin - open.size()), nullptr, false);
}

}  // namespace ft::test
