#include "tests/tidy/source_tree.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

namespace tidy {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 7> folders{"common", "solver", "worker", "coordinator", "tests", "deploy", ".ci"};
constexpr std::array<std::string_view, 8> endings{".cpp", ".hpp", ".cmake", ".txt", ".sh", ".toml", ".md", ".bats"};

bool readable(const fs::path& path) {
  const std::string name = path.filename().string();
  return name == "run" || std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return name.ends_with(ending); });
}

SourceFile read(const fs::path& top, const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return {fs::relative(path, top).generic_string(), text.str()};
}

// Walks code character by character; remembers what it is inside of.
class Blanker {
 public:
  explicit Blanker(std::string_view text) : text_(text), out_(text) {}

  std::string run() {
    while (at_ < text_.size()) step();
    return out_;
  }

 private:
  bool here(std::string_view word) const { return text_.substr(at_, word.size()) == word; }

  void blank(std::size_t end) {
    for (; at_ < std::min(end, text_.size()); ++at_)
      if (text_[at_] != '\n') out_[at_] = ' ';
  }

  std::size_t after(std::string_view word, std::size_t from) const {
    const std::size_t found = text_.find(word, from);
    return found == std::string_view::npos ? text_.size() : found + word.size();
  }

  std::size_t quoted_end(char quote) const {
    std::size_t i = at_ + 1;
    while (i < text_.size() && text_[i] != quote && text_[i] != '\n') i += text_[i] == '\\' ? 2 : 1;
    return i + 1;
  }

  bool digit_separator() const { return at_ > 0 && std::isalnum(static_cast<unsigned char>(text_[at_ - 1])) != 0; }

  void step() {
    if (here("//")) return blank(text_.find('\n', at_));
    if (here("/*")) return blank(after("*/", at_ + 2));
    if (here("R\"")) {
      const std::string close = ")" + std::string(text_.substr(at_ + 2, text_.find('(', at_) - at_ - 2)) + "\"";
      return blank(after(close, at_));
    }
    if (here("#include")) return void(at_ = std::min(text_.find('\n', at_), text_.size()));
    if (here("\"")) return blank(quoted_end('"'));
    if (here("'") && !digit_separator()) return blank(quoted_end('\''));
    ++at_;
  }

  std::string_view text_;
  std::string out_;
  std::size_t at_ = 0;
};

}  // namespace

std::string text_of(const Violations& violations) {
  std::ostringstream out;
  for (const Violation& v : violations) {
    out << v.path;
    if (v.line > 0) out << ":" << v.line;
    out << ": " << v.what << "\n";
  }
  return out.str();
}

Tree read_tree(const fs::path& top) {
  Tree tree;
  for (const auto& entry : fs::directory_iterator(top))
    if (entry.is_regular_file() && readable(entry.path())) tree.push_back(read(top, entry.path()));
  for (const std::string_view folder : folders) {
    if (!fs::exists(top / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(top / folder))
      if (entry.is_regular_file() && readable(entry.path())) tree.push_back(read(top, entry.path()));
  }
  std::sort(tree.begin(), tree.end(), [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return tree;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    lines.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return lines;
}

std::string only_code(std::string_view text) { return Blanker(text).run(); }

std::vector<std::vector<std::string>> ratchet_rows(std::string_view text) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string_view line : lines_of(text)) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream words{std::string(line)};
    std::vector<std::string> row;
    for (std::string word; words >> word;) row.push_back(word);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace tidy
