#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "nodes/types/report.h"

namespace talkgraph {

// Parts of an HTML page. Names and titles are escaped.

std::string html_open(const std::string& title, const std::string& notes);
std::string html_close();

/// The score that a column says more of: "acc" of "acc std", "acc low", "acc high" and "acc p"; empty of any other
/// name.
std::string score_beside(const std::string& column);
/// A mean and what is known of it; NaN where nothing is.
struct Measured {
  double mean = NAN, deviation = NAN, low = NAN, high = NAN, p = NAN;
};
/// p below 0.05.
bool is_significant(double p);
/// "0.59 ± 0.08" and a mark, bold if p is significant; below it the interval, and p.
std::string html_number(const Measured& measured, const std::string& mark = "");
/// A title that says what bold numbers are, if any are.
std::string title_with_key(const std::string& title, bool significant);
/// A table with its title as caption; a column shares its cells with those that say more of it. A cell of "acc: METHOD"
/// that is as "acc" in its row is the best and stands out. More than twenty columns are folded.
std::string html_table(const std::string& name, const Table& table);
/// A table of cells, which the three below make of HTML; a heading, HTML too, stands where the cells below it do.
std::string html_table(const std::string& caption, const std::vector<std::string>& head,
                       const std::vector<std::vector<std::string>>& lines);
/// The only one of a line: heads the lines that follow, and stays in view as their first cells do.
std::string heading_cell(const std::string& html, std::size_t columns);
std::string number_cell(const std::string& html);
std::string text_cell(const std::string& html);
std::string html_plot(const Plot& plot);
/// Whether a browser shows the file as a picture, by its ending.
bool is_picture(const std::string& path);
/// A relative path as a URL: what is no letter, digit or one of "-._~/" is written as %XX.
std::string url_of(const std::string& path);
/// A player or a picture of a file beside the page, a link to one of another kind.
std::string html_clip(const std::string& name, const Artifact& clip);

}  // namespace talkgraph
