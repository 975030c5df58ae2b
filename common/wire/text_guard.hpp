// Text that crosses the wire: valid UTF-8, bounded, no control characters.
#pragma once

#include <string>
#include <string_view>

namespace fracfarm::wire {

bool is_utf8(std::string_view text);
bool is_clean(std::string_view text, std::size_t limit);  // clean_text would give it back; may say no of clean text beyond ASCII
// The text with invalid bytes and control characters (other than newline) as '?', clipped to `limit` bytes at a whole character.
std::string clean_text(std::string_view text, std::size_t limit);

}  // namespace fracfarm::wire
