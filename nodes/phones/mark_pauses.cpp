#include "nodes/phones/mark_pauses.h"

#include <algorithm>
#include <cmath>

#include "nodes/types/visemes.h"

namespace talkgraph {

namespace {

void mark_at_ends(std::vector<std::string>& all) {
  const auto speech = std::find_if_not(all.begin(), all.end(), is_pause);
  const auto end = std::find_if_not(all.rbegin(), std::make_reverse_iterator(speech), is_pause).base();
  for (auto l = all.begin(); l != speech; ++l) *l = "lead_" + *l;
  for (auto l = end; l != all.end(); ++l) *l = "trail_" + *l;
}

void mark_as_heard(std::vector<std::string>& all, std::int64_t wait) {
  bool spoken = false;
  std::int64_t lasts = 0;
  for (auto& label : all) {
    if (!is_pause(label)) {
      spoken = true;
      lasts = 0;
    } else if (!spoken) {
      label = "lead_" + label;
    } else if (++lasts > wait) {
      label = "trail_" + label;
    }
  }
}

}  // namespace

FrameLabels MarkPauses::operator()(const FrameLabels& labels) const {
  FrameLabels marked = labels;
  if (wait > 0)
    mark_as_heard(marked.labels, std::lround(wait * labels.rate.value()));
  else
    mark_at_ends(marked.labels);
  return marked;
}

void describe(Description<MarkPauses>& d) {
  d.type("phones.mark_pauses").summary("pauses before and after an utterance get labels of their own");
  d.source("Thesis §5.4.4");
  d.input("labels", "phones at the video rate").output("labels", "pauses at both ends renamed");
  d.param("wait", &MarkPauses::wait)
      .at_least(0)
      .unit("s")
      .doc("above 0: labels come one by one, and a pause after speech is trailing once it has lasted so long");
}

}  // namespace talkgraph
