#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talkgraph {

/// The lines of a text with their numbers, blank ones left out, line ends removed.
struct TextLine {
  int number = 0;
  std::string text;
};

/// A text file as UTF-8: UTF-16 with a byte order mark is converted, the mark is
/// taken off. Throws std::runtime_error naming the file if it cannot be read.
std::string read_text_file(const std::string& path);
/// Whether JSON can hold a text as it is: names of files may be of other bytes.
bool is_utf8(const std::string& text);
std::vector<TextLine> lines_of(std::string_view text);
std::vector<std::string> split(std::string_view line, char separator);
/// Words between blanks.
std::vector<std::string> words_of(std::string_view line);
std::string lower_case(std::string text);

/// Throws std::runtime_error "file:line: what".
[[noreturn]] void complain(const std::string& file, int line, const std::string& what);
/// The number that a text is, blanks around it left out; "nan" and "inf" are numbers too.
std::optional<double> number_of(std::string_view text);
/// A finite number, or a complaint.
double number_in(const std::string& text, const std::string& file, int line);

}  // namespace talkgraph
