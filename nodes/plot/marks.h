#pragma once

#include <array>
#include <string>

// Pieces of SVG; coordinates are pixels.
namespace talkgraph {

/// Okabe and Ito's: told apart by people with any colour vision.
inline constexpr std::array<const char*, 7> plot_colours = {"#222222", "#d55e00", "#0072b2", "#009e73",
                                                            "#cc79a7", "#e69f00", "#56b4e9"};

/// The start of a picture on white; screen readers are told the title.
std::string svg_open(const std::string& title, double width, double height);
/// `anchor` is start, middle or end; `more` further attributes with a space before.
std::string svg_text(double x, double y, const char* anchor, const std::string& text, const char* more = "");
/// A path that is drawn, not filled; `more` as above.
std::string svg_line(const std::string& path, const char* colour, double width = 1, const char* more = "");
std::string svg_group(double x, double y, const std::string& content);

}  // namespace talkgraph
