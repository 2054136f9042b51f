#include "nodes/types/mouths.h"

#include <opencv2/core.hpp>

namespace talkgraph {

/// The pictures are stored as one, below each other: much smaller than one by one.
void fields(Archive& ar, Mouths& m) {
  ar("points", m.points);
  ar("margin", m.margin);
  ar("parameters", m.parameters);
  Image sheet;
  if (!ar.loading() && !m.pictures.empty()) {
    std::vector<cv::Mat> all;
    for (const auto& picture : m.pictures) all.push_back(picture.pixels);
    cv::vconcat(all, sheet.pixels);
  }
  ar("pictures", sheet);
  if (!ar.loading()) return;
  m.pictures.clear();
  const int height = m.size() > 0 ? sheet.pixels.rows / static_cast<int>(m.size()) : 0;
  for (int i = 0; i < m.size(); ++i) m.pictures.push_back({sheet.pixels.rowRange(i * height, (i + 1) * height)});
}

void fields(Archive& ar, MouthTrack& m) {
  ar("mouths", m.mouths);
  ar("chosen", m.chosen);
}

}  // namespace talkgraph
