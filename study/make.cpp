#include "study/make.h"

#include <fmt/format.h>
#include <unistd.h>

#include <set>
#include <stdexcept>

#include "graph/output_file.h"
#include "study/choose.h"
#include "study/finished_run.h"

namespace talkgraph::study {
namespace {

namespace fs = std::filesystem;

/// Where a study is put together, inside its folder; gone afterwards.
class Desk {
 public:
  explicit Desk(const fs::path& folder) : path_(folder / fmt::format(".desk-{}-study", getpid())) {
    fs::create_directories(path_);
  }
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;
  ~Desk() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    fs::remove(path_.parent_path(), ignored);  // if nothing came of it
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

bool is_clip(const fs::path& file) { return file.extension() == ".webm" || file.extension() == ".mp4"; }

/// Clips without a study are those of a making that was killed at its very end.
void claim(const fs::path& folder) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("{}: {}; name another folder with -o", folder.string(), why));
  };
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder)) refuse("is a file");
  if (fs::exists(folder / "answers.db")) refuse("holds answers to a study already");
  if (fs::exists(folder / "study.json")) refuse("holds a study already");
  sweep_parts(folder);
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() != "clips" || !fs::is_directory(entry.path()))
      refuse(fmt::format("holds other things already ({})", entry.path().filename().string()));
  if (!fs::exists(folder / "clips")) return;
  for (const auto& entry : fs::directory_iterator(folder / "clips"))
    if (!is_clip(entry.path())) refuse("holds other things already (clips/" + entry.path().filename().string() + ")");
  fs::remove_all(folder / "clips");
}

std::vector<FinishedRun> open(const std::vector<fs::path>& folders) {
  std::vector<FinishedRun> runs;
  std::set<fs::path> seen;
  for (const auto& folder : folders) {
    if (!seen.insert(fs::weakly_canonical(folder)).second)
      throw std::invalid_argument(fmt::format("{}: the same run twice", folder.string()));
    runs.emplace_back(folder);
  }
  return runs;
}

/// The speakers' names: those given, else the runs' titles.
std::vector<std::string> names(const Design& design, const std::vector<FinishedRun>& runs, Diagnostics& diagnostics) {
  auto out = design.speakers;
  if (out.empty())
    for (const auto& run : runs) out.push_back(run.title());
  if (out.size() != runs.size())
    diagnostics.error(design.at({"speakers"}),
                      fmt::format("\"speakers\" names {}, but there are {} runs", out.size(), runs.size()));
  std::set<std::string> taken;
  for (const auto& name : out)
    if (!taken.insert(name).second)
      diagnostics.error(design.at({"speakers"}),
                        fmt::format("several runs are called \"{}\": name each in \"speakers\"", name));
  return out;
}

/// Times of files tell nothing, either.
void put(const fs::path& clips, const fs::path& folder) {
  const auto now = fs::file_time_type::clock::now();
  for (const auto& entry : fs::directory_iterator(clips)) fs::last_write_time(entry.path(), now);
  fs::rename(clips, folder);
}

}  // namespace

std::optional<MadeStudy> make_study(const Design& design, const std::vector<fs::path>& folders, const fs::path& folder,
                                    const Registry& registry, const RunGraph& run, Diagnostics& diagnostics) {
  claim(folder);
  auto runs = open(folders);
  const auto speakers = names(design, runs, diagnostics);
  for (auto& each : runs) each.find(design, registry, diagnostics);
  if (!diagnostics.ok()) return {};
  const Desk desk(folder);
  std::vector<Speaker> all;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    all.push_back(runs[r].speaker(registry, run, desk.path()));
    all.back().title = speakers[r];
  }
  MadeStudy made;
  auto study = choose(design, all, made.notes, diagnostics);
  if (!study) return {};
  made.study = *std::move(study);
  for (std::size_t r = 0; r < runs.size(); ++r)
    runs[r].draw(design, made.study, speakers[r], registry, run, desk.path());
  put(desk.path() / "clips", folder / "clips");
  write_study(made.study, folder);
  return made;
}

}  // namespace talkgraph::study
