#pragma once

#include <filesystem>
#include <string>

namespace talkgraph {

/// Draws an SVG on white, `scale` pixels for one of its own, and writes it as a PNG file, whole or not at all. Throws
/// std::runtime_error that names the file: not an SVG, without a size, too large, cannot be written.
void write_png(const std::filesystem::path& file, const std::string& svg, double scale);

}  // namespace talkgraph
