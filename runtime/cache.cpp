#include "runtime/cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

#include "graph/output_file.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;

// Raised when the layout of entries or the making of keys changes: older entries are then out of reach.
constexpr const char* version = "v2";

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// What was built for an entry, or dropped from it, and is gone when this goes.
class Workshop {
 public:
  explicit Workshop(fs::path path) : path_(std::move(path)) {}
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Regular files below a folder, relative to it, sorted. Another process may remove them meanwhile.
std::vector<std::string> files_below(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    if (at->is_regular_file(error)) files.push_back(at->path().lexically_relative(folder).string());
  std::sort(files.begin(), files.end());
  return files;
}

std::string output_file(std::size_t port) { return fmt::format("{}.h5", port); }

void save(const fs::path& file, const Value& value) {
  // An archive that saves does not change what it visits.
  write_hdf5(file, [&](Archive& ar) { value.type().visit(ar, const_cast<void*>(value.data())); });
}

Value load(const fs::path& file, const TypeInfo& type) {
  auto data = type.make();
  const auto archive = hdf5_reader(file.string());
  type.visit(*archive, data.get());
  return Value(std::move(data), &type);
}

/// Size and checksum of every file of an entry but entry.json.
Json inventory(const fs::path& entry) {
  Json files = Json::object();
  for (const auto& name : files_below(entry))
    if (name != "entry.json")
      files[name] = {{"bytes", fs::file_size(entry / name)}, {"key", file_key(entry / name).str()}};
  return files;
}

std::uint64_t bytes_of(const Json& entry) {
  std::uint64_t bytes = 0;
  for (const auto& [name, file] : entry["files"].items()) bytes += file["bytes"].get<std::uint64_t>();
  return bytes;
}

std::string sum_of(Json entry) {
  entry.erase("sum");
  return KeyMaker().add(entry.dump()).key().str();
}

/// The process whose number stands in the name of a work folder is gone.
bool abandoned(const fs::path& work) {
  const int pid = std::atoi(work.filename().c_str());
  return pid > 0 && kill(pid, 0) != 0 && errno == ESRCH;
}

std::optional<Key> key_in(const std::string& name) {
  if (name.size() != 32 || name.find_first_not_of("0123456789abcdef") != std::string::npos) return {};
  return Key{std::stoull(name.substr(0, 16), nullptr, 16), std::stoull(name.substr(16), nullptr, 16)};
}

}  // namespace

Cache::Cache(fs::path folder, std::uint64_t limit)
    : folder_(fs::absolute(folder) / version),
      limit_(limit),
      // Times of files are of a coarser clock.
      opened_(fs::file_time_type::clock::now() - std::chrono::seconds(1)) {
  std::error_code error;
  fs::create_directories(folder_ / "work", error);
  if (error)
    throw std::runtime_error(fmt::format("the cache {} cannot be made: {}", folder_.string(), error.message()));
  if (access(folder_.c_str(), W_OK) != 0)
    throw std::runtime_error(fmt::format("the cache {} may not be written", folder_.string()));
  for (const auto& work : fs::directory_iterator(folder_ / "work", error))
    if (abandoned(work.path())) fs::remove_all(work.path(), error);
}

Cache::~Cache() {
  try {
    if (stored_) prune(limit_);
  } catch (const std::exception&) {
    // It is too large until the next run.
  }
}

Cache::Claim::Claim(const Cache& cache, const Key& key) : cache_(&cache), key_(key) {
  std::unique_lock lock(cache.mutex_);
  cache.unclaimed_.wait(lock, [&] { return cache.claimed_.insert(key).second; });
}

Cache::Claim::~Claim() {
  if (!cache_) return;
  {
    const std::lock_guard lock(cache_->mutex_);
    cache_->claimed_.erase(key_);
  }
  cache_->unclaimed_.notify_all();
}

fs::path Cache::default_folder() {
  const auto in = [](const char* name) { return std::getenv(name) ? fs::path(std::getenv(name)) : fs::path(); };
  if (const auto own = in("TALKGRAPH_CACHE"); !own.empty()) return own;
  if (const auto all = in("XDG_CACHE_HOME"); !all.empty()) return all / "talkgraph";
  const auto home = in("HOME");
  return (home.empty() ? fs::temp_directory_path() : home / ".cache") / "talkgraph";
}

fs::path Cache::place(const Key& key) const {
  const std::string name = key.str();
  return folder_ / name.substr(0, 2) / name;
}

fs::path Cache::work_folder() const {
  std::string name = (folder_ / "work" / fmt::format("{}-XXXXXX", getpid())).string();
  if (!mkdtemp(name.data()))
    throw std::runtime_error(fmt::format("the cache {} cannot be written: {}", folder_.string(), std::strerror(errno)));
  return name;
}

std::vector<std::string> Cache::files(const Key& key) const { return files_below(place(key) / "files"); }

bool Cache::has(const Key& key) const {
  const fs::path file = place(key) / "entry.json";
  return utimensat(AT_FDCWD, file.c_str(), nullptr, 0) == 0;
}

void Cache::damaged(const Key& key, const std::string& what) const {
  const bool gone = !fs::exists(place(key));
  if (!gone) remove(key);
  throw Damaged(fmt::format("the cache entry {} {}; it is made anew", place(key).string(),
                            gone ? "was removed by another run" : what));
}

Json Cache::read_entry(const Key& key) const {
  const Json entry = Json::parse(read_text(place(key) / "entry.json"), nullptr, false);
  if (!entry.is_object() || !entry.contains("sum") || entry["sum"] != sum_of(entry)) return {};
  if (entry.value("key", "") != key.str()) return {};
  return entry;
}

std::string Cache::verify(const Key& key) const { return verify(key, read_entry(key)); }

std::string Cache::verify(const Key& key, const Json& entry) const {
  if (entry.is_null()) return "is not one, or its entry.json was altered";
  try {
    const Json there = inventory(place(key));
    for (const auto& [name, file] : entry["files"].items()) {
      if (!there.contains(name)) return "lacks " + name;
      if (there[name] != file) return fmt::format("has a damaged file, {}", name);
    }
    return there.size() == entry["files"].size() ? "" : "holds files that do not belong to it";
  } catch (const std::exception& e) {
    return e.what();
  }
}

Cache::Result Cache::load(const Key& key, const NodeType& type, const fs::path& folder) const {
  const Json entry = read_entry(key);
  if (const auto wrong = verify(key, entry); !wrong.empty()) damaged(key, wrong);
  Result result;
  result.outputs.resize(type.outputs.size());
  try {
    result.seconds = entry["seconds"].get<double>();
    result.bytes = bytes_of(entry);
    result.warnings = entry["warnings"].get<std::vector<std::string>>();
    for (std::size_t p = 0; p < type.outputs.size(); ++p)
      if (entry["files"].contains(output_file(p)))
        result.outputs[p] = talkgraph::load(place(key) / output_file(p), *type.outputs[p].info);
  } catch (const std::exception& e) {
    damaged(key, e.what());
  }
  deliver(key, entry, folder);
  return result;
}

void Cache::deliver(const Key& key, const Json& entry, const fs::path& folder) const {
  for (const auto& [name, file] : entry["files"].items()) {
    if (!name.starts_with("files/")) continue;
    OutputFile copy(folder / name.substr(std::string_view("files/").size()));
    std::error_code error;
    fs::copy_file(place(key) / name, copy.part(), fs::copy_options::overwrite_existing, error);
    if (error && !fs::exists(place(key) / name)) damaged(key, "lacks " + name);
    if (error) throw fs::filesystem_error("a result cannot be put into the run folder", folder, error);
    copy.finish();
  }
}

std::uint64_t Cache::store(const Key& key, const Json& about, const Result& result, const fs::path& written) {
  const Workshop work(work_folder());
  const fs::path made = work.path() / key.str();
  fs::create_directory(made);
  for (std::size_t p = 0; p < result.outputs.size(); ++p)
    if (result.outputs[p]) save(made / output_file(p), result.outputs[p]);
  if (!written.empty()) fs::copy(written, made / "files", fs::copy_options::recursive);
  Json entry = {{"key", key.str()},
                {"about", about},
                {"seconds", result.seconds},
                {"warnings", result.warnings},
                {"files", inventory(made)}};
  entry["sum"] = sum_of(entry);
  write_file(made / "entry.json", entry.dump(1));
  fs::create_directories(place(key).parent_path());
  const auto bytes = bytes_of(entry);
  const auto put = [&] {
    std::error_code error;
    fs::rename(made, place(key), error);
    return error;
  };
  auto error = put();
  const auto taken = [&] { return error == std::errc::directory_not_empty || error == std::errc::file_exists; };
  if (taken() && read_entry(key).is_null() && remove(key)) error = put();
  if (error && !taken()) throw fs::filesystem_error("the cache cannot keep a result", place(key), error);
  stored_ = true;
  // Looking at all entries is not free: done whenever another tenth of the limit has come.
  if ((grown_ += bytes) >= limit_ / 10) {
    grown_ = 0;
    prune(limit_, opened_);
  }
  return bytes;
}

bool Cache::remove(const Key& key) const {
  // Aside first, so that nobody sees half of it. That needs no room on the disk.
  const Workshop aside(folder_ / "work" / fmt::format("{}-{}", getpid(), key.str()));
  std::error_code error;
  fs::rename(place(key), aside.path(), error);
  if (error) fs::remove_all(place(key), error);
  return !fs::exists(place(key), error);
}

std::vector<Cache::Entry> Cache::entries() const {
  std::vector<Entry> all;
  std::error_code error;
  for (const auto& group : fs::directory_iterator(folder_, error)) {
    if (group.path().filename().string().size() != 2) continue;
    for (const auto& found : fs::directory_iterator(group.path(), error)) {
      const auto key = key_in(found.path().filename().string());
      if (!key) continue;
      auto used = fs::last_write_time(found.path() / "entry.json", error);
      if (error) used = fs::last_write_time(found.path(), error);
      if (error) continue;  // another process was faster
      Entry entry{*key, {}, 0, used};
      for (const auto& name : files_below(found.path())) {
        const auto bytes = fs::file_size(found.path() / name, error);
        if (!error) entry.bytes += bytes;
      }
      const Json json = read_entry(*key);
      if (!json.is_null()) entry.about = json["about"];
      all.push_back(std::move(entry));
    }
  }
  std::sort(all.begin(), all.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  return all;
}

std::uint64_t Cache::prune(std::uint64_t bytes, fs::file_time_type spared) const {
  const auto all = entries();
  std::uint64_t total = 0, freed = 0;
  for (const auto& entry : all) total += entry.bytes;
  for (const auto& entry : all) {
    if (total - freed <= bytes || entry.used >= spared) break;
    if (remove(entry.key)) freed += entry.bytes;
  }
  return freed;
}

}  // namespace talkgraph
