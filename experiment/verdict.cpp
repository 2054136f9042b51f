#include "experiment/verdict.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "nodes/report/page.h"

namespace talkgraph {

std::vector<Verdict> verdicts(const std::vector<const Estimate*>& estimates) {
  constexpr std::string_view behind = " behind", won = " won";
  std::vector<Verdict> all;
  std::set<std::pair<std::size_t, std::string>> tested;  // settings, scores
  for (const Estimate* e : estimates) {
    if (!e->measure.ends_with(behind)) continue;
    const std::string score = e->measure.substr(0, e->measure.size() - behind.size());
    auto it = std::ranges::find_if(all, [&](const Verdict& v) { return v.setting == e->setting && v.score == score; });
    if (it == all.end())
      it = all.insert(all.end(), Verdict{.setting = e->setting, .score = score, .best = {}, .close = {}});
    if (!std::isnan(e->p)) tested.emplace(e->setting, score);
    if (e->mean == 0 && it->best.empty())
      it->best = e->row;
    else if (is_significant(e->p))
      ++it->beaten;
    else
      it->close.push_back({e->row, e->mean});
  }
  for (Verdict& v : all) {
    std::ranges::stable_sort(v.close, {}, &Verdict::Close::behind);
    for (const Estimate* e : estimates)
      if (e->setting == v.setting && e->row == v.best && e->measure == v.score + std::string(won)) v.won = e->mean;
  }
  std::erase_if(all, [&](const Verdict& v) { return v.best.empty() || !tested.contains({v.setting, v.score}); });
  std::ranges::stable_sort(all, {}, &Verdict::setting);
  return all;
}

}  // namespace talkgraph
