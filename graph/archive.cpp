#include "graph/archive.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <xxhash.h>

#include <filesystem>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <utility>

namespace talkgraph {
namespace {

/// An HDF5 identifier that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) throw std::runtime_error(what);
  }
  Handle(Handle&& o) noexcept : id_(std::exchange(o.id_, -1)), close_(o.close_) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// What reading and writing share: the file, and the group that is open.
class Hdf5Archive : public Archive {
 protected:
  template <class Open>
  Hdf5Archive(std::string path, const char* failure, Open open) : lock_(library()), path_(std::move(path)) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    groups_.emplace_back(open(), H5Fclose, path_ + ": " + failure);
  }

  hid_t group() const { return groups_.back(); }
  void leave() override {
    groups_.pop_back();
    names_.pop_back();
  }
  void push(std::string_view name, Handle group) {
    groups_.push_back(std::move(group));
    names_.emplace_back(name);
  }
  std::string place(std::string_view name) const {
    std::string at;
    for (const auto& n : names_) at += "/" + n;
    return fmt::format("{}: {}/{}", path_, at, name);
  }

 private:
  // Debian's HDF5 is not thread-safe: one archive at a time.
  static std::mutex& library() {
    static std::mutex mutex;
    return mutex;
  }

  std::unique_lock<std::mutex> lock_;
  std::string path_;
  std::vector<Handle> groups_;
  std::vector<std::string> names_;
};

class Hdf5Writer final : public Hdf5Archive {
 public:
  explicit Hdf5Writer(const std::string& path)
      : Hdf5Archive(path, "cannot be created",
                    [&] { return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT); }) {}
  bool loading() const override { return false; }

 protected:
  void number(std::string_view name, double& v) override { attribute(name, H5T_NATIVE_DOUBLE, &v); }
  void integer(std::string_view name, std::int64_t& v) override { attribute(name, H5T_NATIVE_INT64, &v); }
  void text(std::string_view name, std::string& v) override {
    const std::vector<std::uint8_t> raw(v.begin(), v.end());
    dataset(name, H5T_NATIVE_UINT8, {raw.size()}, raw.data());
  }
  void texts(std::string_view name, std::vector<std::string>& v) override {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, place(name));
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    std::vector<const char*> raw;
    for (const auto& s : v) raw.push_back(s.c_str());
    dataset(name, type, {raw.size()}, raw.data());
  }
  void numbers(std::string_view name, std::vector<double>& v) override {
    dataset(name, H5T_NATIVE_DOUBLE, {v.size()}, v.data());
  }
  void integers(std::string_view name, std::vector<std::int64_t>& v) override {
    dataset(name, H5T_NATIVE_INT64, {v.size()}, v.data());
  }
  void bytes(std::string_view name, std::vector<std::uint8_t>& v) override {
    dataset(name, H5T_NATIVE_UINT8, {v.size()}, v.data());
  }
  void matrix(std::string_view name, Eigen::MatrixXd& v) override {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = v;
    dataset(name, H5T_NATIVE_DOUBLE, {static_cast<hsize_t>(v.rows()), static_cast<hsize_t>(v.cols())}, rows.data());
  }
  void enter(std::string_view name) override {
    const std::string what = place(name) + ": cannot be written";
    push(name,
         Handle(H5Gcreate2(group(), std::string(name).c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, what));
  }

 private:
  void attribute(std::string_view name, hid_t type, const void* data) {
    const std::string what = place(name) + ": cannot be written";
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, what);
    const Handle attr(H5Acreate2(group(), std::string(name).c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                      what);
    if (H5Awrite(attr, type, data) < 0) throw std::runtime_error(what);
  }
  void dataset(std::string_view name, hid_t type, std::vector<hsize_t> size, const void* data) {
    const std::string what = place(name) + ": cannot be written";
    const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose, what);
    const Handle set(H5Dcreate2(group(), std::string(name).c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                     H5Dclose, what);
    hsize_t count = 1;
    for (const auto n : size) count *= n;
    if (count && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) throw std::runtime_error(what);
  }
};

/// What is wrong with a file, should it not open.
const char* complaint(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return "is missing";
  if (std::filesystem::file_size(path, ignored) == 0) return "is empty";
  std::string start(8, 0);
  std::ifstream(path, std::ios::binary).read(start.data(), 8);
  return start == "\x89HDF\r\n\x1a\n" ? "is cut short, damaged, or being written" : "is not an HDF5 file";
}

class Hdf5Reader final : public Hdf5Archive {
 public:
  explicit Hdf5Reader(const std::string& path)
      : Hdf5Archive(path, complaint(path), [&] { return H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT); }) {}
  bool loading() const override { return true; }

 protected:
  void number(std::string_view name, double& v) override { attribute(name, H5T_NATIVE_DOUBLE, &v); }
  void integer(std::string_view name, std::int64_t& v) override { attribute(name, H5T_NATIVE_INT64, &v); }
  void text(std::string_view name, std::string& v) override {
    std::vector<std::uint8_t> raw;
    bytes(name, raw);
    v.assign(raw.begin(), raw.end());
  }
  void texts(std::string_view name, std::vector<std::string>& v) override {
    const Handle set = open(name);
    const auto size = shape(set, 1, name);
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, place(name));
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    std::vector<char*> raw(size[0]);
    read(set, type, raw.data(), size[0], name);
    v.clear();
    for (auto* s : raw) {
      v.emplace_back(s ? s : "");
      H5free_memory(s);
    }
  }
  void numbers(std::string_view name, std::vector<double>& v) override { list(name, H5T_NATIVE_DOUBLE, v); }
  void integers(std::string_view name, std::vector<std::int64_t>& v) override { list(name, H5T_NATIVE_INT64, v); }
  void bytes(std::string_view name, std::vector<std::uint8_t>& v) override { list(name, H5T_NATIVE_UINT8, v); }
  void matrix(std::string_view name, Eigen::MatrixXd& v) override {
    const Handle set = open(name);
    const auto size = shape(set, 2, name);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows(size[0], size[1]);
    read(set, H5T_NATIVE_DOUBLE, rows.data(), size[0] * size[1], name);
    v = rows;
  }
  void enter(std::string_view name) override {
    const std::string what = place(name) + ": is missing";
    push(name, Handle(H5Gopen2(group(), std::string(name).c_str(), H5P_DEFAULT), H5Gclose, what));
  }

 private:
  void attribute(std::string_view name, hid_t type, void* data) {
    const std::string what = place(name) + ": is missing or cannot be read";
    const Handle attr(H5Aopen(group(), std::string(name).c_str(), H5P_DEFAULT), H5Aclose, what);
    if (H5Aread(attr, type, data) < 0) throw std::runtime_error(what);
  }
  Handle open(std::string_view name) {
    return {H5Dopen2(group(), std::string(name).c_str(), H5P_DEFAULT), H5Dclose, place(name) + ": is missing"};
  }
  std::vector<hsize_t> shape(hid_t set, int dimensions, std::string_view name) {
    const Handle space(H5Dget_space(set), H5Sclose, place(name));
    std::vector<hsize_t> size(static_cast<std::size_t>(dimensions));
    if (H5Sget_simple_extent_ndims(space) != dimensions)
      throw std::runtime_error(place(name) + ": has the wrong number of dimensions");
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
    return size;
  }
  void read(hid_t set, hid_t type, void* data, hsize_t count, std::string_view name) {
    if (count && H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
      throw std::runtime_error(place(name) + ": cannot be read: the file is damaged");
  }
  template <class T>
  void list(std::string_view name, hid_t type, std::vector<T>& v) {
    const Handle set = open(name);
    const auto size = shape(set, 1, name);
    v.resize(size[0]);
    read(set, type, v.data(), size[0], name);
  }
};

class HashArchive final : public Archive {
 public:
  HashArchive() : state_(XXH3_createState()) { XXH3_128bits_reset(state_); }
  ~HashArchive() override { XXH3_freeState(state_); }
  bool loading() const override { return false; }
  bool hashing() const override { return true; }
  Key key() const {
    const auto h = XXH3_128bits_digest(state_);
    return {h.high64, h.low64};
  }

 protected:
  void number(std::string_view name, double& v) override { block(name, 'd', &v, 1, sizeof v); }
  void integer(std::string_view name, std::int64_t& v) override { block(name, 'i', &v, 1, sizeof v); }
  void text(std::string_view name, std::string& v) override { block(name, 's', v.data(), v.size(), 1); }
  void texts(std::string_view name, std::vector<std::string>& v) override {
    enter(name);
    for (auto& s : v) text("", s);
    leave();
  }
  void numbers(std::string_view name, std::vector<double>& v) override {
    block(name, 'd', v.data(), v.size(), sizeof(double));
  }
  void integers(std::string_view name, std::vector<std::int64_t>& v) override {
    block(name, 'i', v.data(), v.size(), sizeof(std::int64_t));
  }
  void bytes(std::string_view name, std::vector<std::uint8_t>& v) override { block(name, 'b', v.data(), v.size(), 1); }
  void matrix(std::string_view name, Eigen::MatrixXd& v) override {
    std::int64_t rows = v.rows();
    integer("rows", rows);
    block(name, 'm', v.data(), static_cast<std::size_t>(v.size()), sizeof(double));
  }
  void enter(std::string_view name) override { block(name, '{', nullptr, 0, 0); }
  void leave() override { block("", '}', nullptr, 0, 0); }

 private:
  // Name, kind and size go in too, so that neighbouring members cannot trade bytes.
  void block(std::string_view name, char kind, const void* data, std::size_t count, std::size_t size) {
    XXH3_128bits_update(state_, name.data(), name.size());
    XXH3_128bits_update(state_, &kind, 1);
    const std::uint64_t n = count;
    XXH3_128bits_update(state_, &n, sizeof n);
    if (count) XXH3_128bits_update(state_, data, count * size);
  }

  XXH3_state_t* state_;
};

}  // namespace

std::unique_ptr<Archive> hdf5_writer(const std::string& path) { return std::make_unique<Hdf5Writer>(path); }
std::unique_ptr<Archive> hdf5_reader(const std::string& path) { return std::make_unique<Hdf5Reader>(path); }

Key content_key(const std::function<void(Archive&)>& visit) {
  HashArchive hash;
  visit(hash);
  return hash.key();
}

}  // namespace talkgraph
