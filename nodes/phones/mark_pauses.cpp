#include "nodes/phones/mark_pauses.h"

#include <algorithm>

#include "nodes/types/visemes.h"

namespace talkgraph {

FrameLabels MarkPauses::operator()(const FrameLabels& labels) const {
  FrameLabels marked = labels;
  auto& all = marked.labels;
  const auto speech = std::find_if_not(all.begin(), all.end(), is_pause);
  const auto end = std::find_if_not(all.rbegin(), std::make_reverse_iterator(speech), is_pause).base();
  for (auto l = all.begin(); l != speech; ++l) *l = "lead_" + *l;
  for (auto l = end; l != all.end(); ++l) *l = "trail_" + *l;
  return marked;
}

void describe(Description<MarkPauses>& d) {
  d.type("phones.mark_pauses").summary("pauses before and after an utterance get labels of their own");
  d.source("Thesis §5.4.4");
  d.input("labels", "phones at the video rate").output("labels", "pauses at both ends renamed");
}

}  // namespace talkgraph
