#include "common/base/terminal.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "common/base/clock.hpp"

namespace fracfarm {
namespace {

std::size_t glyphs(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

bool looks_like_number(std::string_view text) {
  return text.empty() || text == "-" || (std::strchr("0123456789+-.", text[0]) != nullptr && text.find_first_of("0123456789") != text.npos);
}

}  // namespace

bool is_terminal(std::FILE* stream) { return ::isatty(::fileno(stream)) != 0; }

std::string ink(std::string_view text, Ink colour, std::FILE* stream) {
  static constexpr const char* codes[] = {"", "\x1b[1m", "\x1b[2m", "\x1b[31m", "\x1b[32m", "\x1b[33m", "\x1b[34m"};
  const char* no_color = std::getenv("NO_COLOR");
  if (colour == Ink::plain || !is_terminal(stream) || (no_color && *no_color)) return std::string(text);
  return codes[static_cast<int>(colour)] + std::string(text) + "\x1b[0m";
}

std::string table_text(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  std::vector<bool> numeric;
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < rows[r].size(); ++c) {
      if (c >= widths.size()) widths.resize(c + 1, 0), numeric.resize(c + 1, true);
      widths[c] = std::max(widths[c], glyphs(rows[r][c]));
      if (r > 0 && !looks_like_number(rows[r][c])) numeric[c] = false;
    }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string pad(widths[c] - glyphs(row[c]), ' ');
      line += (c ? "  " : "") + (numeric[c] && rows.size() > 1 ? pad + row[c] : row[c] + pad);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

ProgressLine::ProgressLine(std::FILE* stream, double quiet_interval_s)
    : stream_(stream), terminal_(is_terminal(stream)), quiet_interval_s_(quiet_interval_s) {}

ProgressLine::~ProgressLine() {
  if (open_) std::fputc('\n', stream_);
}

void ProgressLine::show(const std::string& line) {
  const double now = SystemClock{}.monotonic_s();
  if (now - last_s_ < (terminal_ ? 0.1 : quiet_interval_s_)) return;
  last_s_ = now;
  if (terminal_) {
    std::fprintf(stream_, "\r\x1b[K%s", line.c_str());
    open_ = true;
  } else {
    std::fprintf(stream_, "%s\n", line.c_str());
  }
  std::fflush(stream_);
}

void ProgressLine::finish(const std::string& line) {
  std::fprintf(stream_, terminal_ ? "\r\x1b[K%s\n" : "%s\n", line.c_str());
  std::fflush(stream_);
  open_ = false;
}

}  // namespace fracfarm
