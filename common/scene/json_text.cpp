#include "common/scene/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/base/text.hpp"

namespace fracfarm {
namespace {

using nlohmann::json;

// Builds the value while it watches the bounds; nlohmann's own builder would take a repeated key's last value in silence.
class BoundedBuilder : public nlohmann::json_sax<json> {
 public:
  BoundedBuilder(const JsonBounds& bounds, std::string_view name) : bounds_(bounds), name_(name) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return refuse("binary data", "JSON text"); }

  bool start_object(std::size_t) override { return open(json::object()); }
  bool start_array(std::size_t) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& word) override {
    key_ = std::move(word);
    if (!stack_.back()->contains(key_)) return true;
    return refuse(fmt::format("key '{}' twice", key_.substr(0, 60)), "each key once in an object");
  }

  bool parse_error(std::size_t position, const std::string& last, const nlohmann::detail::exception& what) override {
    position_ = position;
    const bool overflow = what.id == 406;
    return refuse(fmt::format("'{}'", last.size() > 40 ? last.substr(last.size() - 40) : last),
                  overflow ? "numbers that a double can hold" : "JSON text");
  }

  json take() { return std::move(root_); }
  const Problems& problems() const { return problems_; }
  std::size_t position() const { return position_; }

 private:
  bool refuse(std::string value, std::string limit) {
    problems_.push_back({std::string(name_), std::move(value), std::move(limit), ""});
    return false;
  }

  json* place(json&& value) {
    if (stack_.empty()) return &(root_ = std::move(value));
    if (stack_.back()->is_array()) return &stack_.back()->emplace_back(std::move(value));
    return &((*stack_.back())[key_] = std::move(value));
  }

  bool add(json&& value) {
    if (++values_ > bounds_.max_values) return refuse("more values", fmt::format("at most {} values", bounds_.max_values));
    place(std::move(value));
    return true;
  }

  bool open(json&& container) {
    if (stack_.size() >= bounds_.max_depth) return refuse("deeper nesting", fmt::format("at most {} levels", bounds_.max_depth));
    if (++values_ > bounds_.max_values) return refuse("more values", fmt::format("at most {} values", bounds_.max_values));
    stack_.push_back(place(std::move(container)));
    return true;
  }

  bool close() {
    stack_.pop_back();
    return true;
  }

  JsonBounds bounds_;
  std::string_view name_;
  json root_;
  std::vector<json*> stack_;  // open containers; a parent never grows while its child is open
  std::string key_;
  Problems problems_;
  std::size_t values_ = 0;
  std::size_t position_ = 0;
};

std::string line_and_column(std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, std::min(position == 0 ? 0 : position - 1, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');
  return fmt::format("line {}, column {}", line, before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1);
}

// How containers are spaced. Compact: no blanks at all.
struct Layout {
  std::string_view comma = ",", colon = ":";
  std::size_t line = std::string::npos;  // containers longer than this break at their items
};

// Text of a container whose items are already texts.
std::string enclose(const std::vector<std::string>& items, bool object, const Layout& layout, std::size_t indent) {
  std::size_t length = indent + 2;
  for (const std::string& item : items) length += item.size() + layout.comma.size();
  const bool broken = layout.line != std::string::npos && length > layout.line;
  const std::string open_line = broken ? "\n" + std::string(indent + 2, ' ') : "";
  std::string out(1, object ? '{' : '[');
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) out += broken ? std::string_view(",") : layout.comma;
    out += open_line + items[i];
  }
  if (broken) out += "\n" + std::string(indent, ' ');
  return out + (object ? '}' : ']');
}

std::string text_of(const json& value, const Layout& layout, std::size_t indent) {
  if (value.is_number_float()) {
    assert(std::isfinite(value.get<double>()));
    return shortest(value.get<double>() + 0.0);  // -0 becomes 0: JSON readers lose its sign
  }
  if (!value.is_structured()) return value.dump(-1, ' ', false, json::error_handler_t::replace);
  std::vector<std::string> items;
  items.reserve(value.size());
  for (auto item = value.begin(); item != value.end(); ++item) {
    std::string key = value.is_object() ? json(item.key()).dump(-1, ' ', false, json::error_handler_t::replace) : "";
    if (value.is_object()) key += layout.colon;
    items.push_back(key + text_of(*item, layout, indent + 2));
  }
  return enclose(items, value.is_object(), layout, indent);
}

}  // namespace

Parsed<json> read_json(std::string_view text, std::string_view name, const JsonBounds& bounds) {
  if (text.size() > bounds.max_bytes)
    return tl::unexpected(
        Problems{{std::string(name), bytes_text(text.size()), fmt::format("at most {}", bytes_text(bounds.max_bytes)), ""}});
  BoundedBuilder builder(bounds, name);
  if (json::sax_parse(text.begin(), text.end(), &builder)) return builder.take();
  Problems problems = builder.problems();
  if (problems.empty()) problems.push_back({std::string(name), "text", "JSON text", ""});
  if (builder.position() > 0) problems.back().suggestion = "see " + line_and_column(text, builder.position());
  return tl::unexpected(std::move(problems));
}

std::string compact_text(const json& value) { return text_of(value, {}, 0); }

std::string pretty_text(const json& value) { return text_of(value, {.comma = ", ", .colon = ": ", .line = 120}, 0) + "\n"; }

}  // namespace fracfarm
