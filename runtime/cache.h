#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "graph/json.h"
#include "graph/key.h"
#include "graph/node_type.h"

namespace talkgraph {

/// Results of node calls on disk, found by their keys.
///
/// An entry is a folder <cache>/<first two digits>/<key> with entry.json (what
/// was called, checksums), a file <port>.h5 for each output with a value, and
/// files/ with what a sink wrote. It appears whole, by a rename; several
/// processes may use one cache. The least recently used entries go when the
/// cache grows over its limit; those used since it was opened only when it is closed.
class Cache {
 public:
  /// An entry that is truncated, altered or not from here, and has been removed; or that another process removed.
  struct Damaged : std::runtime_error {
    using std::runtime_error::runtime_error;
  };

  struct Entry {
    Key key;
    Json about;               ///< as given to store(), and "seconds"
    std::uint64_t bytes = 0;  ///< on disk
    std::filesystem::file_time_type used;
  };

  /// What a call gave, as it is kept.
  struct Result {
    std::vector<Value> outputs;         ///< one a port; empty where there is nothing
    std::vector<std::string> warnings;  ///< that the call gave
    double seconds = 0;                 ///< that it took
    std::uint64_t bytes = 0;            ///< on disk, where it was loaded
  };

  /// The right to make a result; until it goes, others of this process who want the same one wait.
  class Claim {
   public:
    Claim() = default;
    Claim(const Cache& cache, const Key& key);
    Claim(Claim&& other) noexcept : cache_(std::exchange(other.cache_, nullptr)), key_(other.key_) {}
    Claim& operator=(Claim&&) = delete;
    ~Claim();

   private:
    const Cache* cache_ = nullptr;
    Key key_;
  };

  /// Makes the folder if need be. Throws std::runtime_error if that cannot be, or if the folder holds other things
  /// than a cache of this version.
  explicit Cache(std::filesystem::path folder, std::uint64_t limit = default_limit);
  ~Cache();
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;

  static constexpr std::uint64_t default_limit = 20'000'000'000;
  /// $TALKGRAPH_CACHE, else talkgraph in $XDG_CACHE_HOME, else ~/.cache/talkgraph.
  static std::filesystem::path default_folder();

  const std::filesystem::path& folder() const { return folder_; }
  std::uint64_t limit() const { return limit_; }

  /// Whether there is an entry; marks it as used.
  bool has(const Key& key) const;
  /// What the sink of an entry wrote, below the run folder.
  std::vector<std::string> files(const Key& key) const;
  /// The outputs of a call of `type`; what its sink wrote is put below `folder`. Throws Damaged.
  Result load(const Key& key, const NodeType& type, const std::filesystem::path& folder) const;
  /// Keeps a result; `written` is the folder with a sink's files, or empty. Where another process was faster its
  /// entry stays. Throws std::runtime_error, on a full disk for one; the cache is then as before. Gives the
  /// bytes that it takes.
  std::uint64_t store(const Key& key, const Json& about, const Result& result, const std::filesystem::path& written);
  /// Removes an entry; false if it is still there.
  bool remove(const Key& key) const;

  /// All entries, the longest unused first, damaged ones among them. What is no entry is passed over.
  std::vector<Entry> entries() const;
  /// Reads an entry whole; says what is wrong with it, nothing if it is sound.
  std::string verify(const Key& key) const;
  /// Removes the longest unused entries until no more than `bytes` are left, but none used at `spared` or later; gives
  /// what was freed.
  std::uint64_t prune(std::uint64_t bytes,
                      std::filesystem::file_time_type spared = std::filesystem::file_time_type::max()) const;

  /// A folder of this process for what is being made, on the disk of the cache.
  std::filesystem::path work_folder() const;

 private:
  std::filesystem::path place(const Key& key) const;
  Json read_entry(const Key& key) const;
  [[noreturn]] void damaged(const Key& key, const std::string& what) const;
  /// What is wrong with an entry whose entry.json was read.
  std::string verify(const Key& key, const Json& entry) const;
  void deliver(const Key& key, const Json& entry, const std::filesystem::path& folder) const;

  std::filesystem::path folder_;
  std::uint64_t limit_;
  std::filesystem::file_time_type opened_;
  std::atomic<std::uint64_t> grown_{0};  // since the last look at all entries
  std::atomic<bool> stored_{false};
  mutable std::mutex mutex_;
  mutable std::condition_variable unclaimed_;
  mutable std::set<Key> claimed_;
};

}  // namespace talkgraph
