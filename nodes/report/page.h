#pragma once

#include <string>
#include <vector>

#include "nodes/types/report.h"

namespace talkgraph {

// Parts of an HTML page. Names and titles are escaped.

std::string html_open(const std::string& title, const std::string& notes);
std::string html_close();

/// A table with its title as caption; a column and its "NAME std" share cells, "0.59 ± 0.08".
std::string html_table(const std::string& name, const Table& table);
/// A table of cells, which the two below make of HTML; a heading stands where the cells below it do.
std::string html_table(const std::string& caption, const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& lines);
std::string number_cell(const std::string& html);
std::string text_cell(const std::string& html);
std::string html_plot(const Plot& plot);
/// Whether a browser shows the file as a picture, by its ending.
bool is_picture(const std::string& path);
/// A player or a picture of a file beside the page, a link to one of another kind.
std::string html_clip(const std::string& name, const Artifact& clip);

}  // namespace talkgraph
