#include "graph/archive.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "graph/output_file.h"

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

/// Of texts of `length` bytes, padded with zeros. HDF5 knows no text of length 0. The bytes are UTF-8, the character
/// set that the file names is HDF5's default, ASCII.
Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "a text cannot be kept");
  H5Tset_size(type, std::max<std::size_t>(length, 1));
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

/// What reading and writing share: the file, and the group that is open.
class Hdf5Archive : public Archive {
 protected:
  template <class Open>
  Hdf5Archive(std::string path, const char* failure, Open open) : lock_(library()), path_(std::move(path)) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    groups_.emplace_back(open(), H5Fclose, path_ + ": " + failure);
  }

  const std::string& path() const { return path_; }
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

/// Makes the bytes of a file in memory: HDF5 does not survive a full disk.
class Hdf5Writer final : public Hdf5Archive {
 public:
  /// `image` is the file once the writer is gone.
  Hdf5Writer(const std::string& path, std::string& image)
      : Hdf5Archive(path, "cannot be created", [&] { return create(image); }) {}
  /// Cuts the image to the size of the file.
  void finish() {
    if (H5Fflush(group(), H5F_SCOPE_LOCAL) < 0) throw std::runtime_error(path() + ": cannot be made");
  }
  bool loading() const override { return false; }
  void note(std::string_view member, std::string_view what, std::string_view text) override {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "a text cannot be kept");
    H5Tset_size(type, H5T_VARIABLE);  // as h5py makes a str of
    H5Tset_cset(type, H5T_CSET_UTF8);
    const std::string terminated(text);
    const char* const data = terminated.c_str();
    attribute(member, what, type, &data);
  }
  void note(std::string_view member, std::string_view what, double number) override {
    attribute(member, what, H5T_NATIVE_DOUBLE, &number);
  }

 protected:
  void number(std::string_view name, double& v) override { dataset(name, H5T_NATIVE_DOUBLE, {}, &v); }
  void integer(std::string_view name, std::int64_t& v) override { dataset(name, H5T_NATIVE_INT64, {}, &v); }
  void text(std::string_view name, std::string& v) override { dataset(name, text_type(v.size()), {}, v.c_str()); }
  void texts(std::string_view name, std::vector<std::string>& v) override {
    std::size_t length = 1;
    for (const auto& s : v) length = std::max(length, s.size());
    std::string raw;
    for (const auto& s : v) raw += s + std::string(length - s.size(), '\0');
    dataset(name, text_type(length), {v.size()}, raw.data());
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
  void matrices(std::string_view name, std::vector<Eigen::MatrixXd>& v) override {
    const Eigen::MatrixXd none;
    const Eigen::MatrixXd& first = v.empty() ? none : v.front();
    const bool alike = std::all_of(v.begin(), v.end(), [&](const Eigen::MatrixXd& m) {
      return m.rows() == first.rows() && m.cols() == first.cols();
    });
    if (!alike) {
      std::size_t size = v.size();
      return list(name, size, [&](std::size_t i) { matrix(std::to_string(i), v[i]); });
    }
    std::vector<double> all;
    for (const auto& m : v)
      for (const auto row : m.rowwise()) all.insert(all.end(), row.begin(), row.end());
    const auto rows = static_cast<hsize_t>(first.rows()), columns = static_cast<hsize_t>(first.cols());
    dataset(name, H5T_NATIVE_DOUBLE, {v.size(), rows, columns}, all.data());
  }
  bool present(std::string_view, bool value) override { return value; }
  void enter(std::string_view name) override {
    const std::string what = place(name) + ": cannot be written";
    push(name,
         Handle(H5Gcreate2(group(), std::string(name).c_str(), H5P_DEFAULT, timeless(H5P_GROUP_CREATE), H5P_DEFAULT),
                H5Gclose, what));
  }

 private:
  /// A file that HDF5 1.8 and later read: small groups take little room.
  static hid_t create(std::string& image) {
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "an HDF5 file cannot be made");
    H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18);
    H5FD_file_image_callbacks_t memory = {
        [](size_t size, H5FD_file_image_op_t, void* bytes) { return resized(bytes, size); },
        nullptr,
        [](void*, size_t size, H5FD_file_image_op_t, void* bytes) { return resized(bytes, size); },
        [](void*, H5FD_file_image_op_t, void*) { return herr_t{0}; },
        [](void* bytes) { return bytes; },
        [](void*) { return herr_t{0}; },
        &image};
    H5Pset_file_image_callbacks(access, &memory);
    H5Pset_fapl_core(access, 1, false);
    return H5Fcreate("in memory", H5F_ACC_TRUNC, timeless(H5P_FILE_CREATE), access);
  }
  /// Null if memory is short: HDF5 is C.
  static void* resized(void* image, std::size_t size) noexcept try {
    auto& bytes = *static_cast<std::string*>(image);
    bytes.resize(size);
    return bytes.data();
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
  /// Objects that do not say when they were made: the same value gives the same bytes.
  static Handle timeless(hid_t kind) {
    Handle properties(H5Pcreate(kind), H5Pclose, "an HDF5 object cannot be made");
    H5Pset_obj_track_times(properties, false);
    return properties;
  }
  void attribute(std::string_view member, std::string_view what, hid_t type, const void* data) {
    const std::string failure = place(member) + ": cannot be written";
    const std::string object = member.empty() ? "." : std::string(member);
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose, failure);
    const Handle attr(H5Acreate_by_name(group(), object.c_str(), std::string(what).c_str(), type, space, H5P_DEFAULT,
                                        H5P_DEFAULT, H5P_DEFAULT),
                      H5Aclose, failure);
    if (H5Awrite(attr, type, data) < 0) throw std::runtime_error(failure);
  }
  /// Whether a long list is of numbers rounded so far that compressing them, which loses nothing, halves them.
  static bool is_coarse(const double* numbers, hsize_t count) {
    if (count < (1 << 16)) return false;
    const auto rounded = std::count_if(numbers, numbers + count,
                                       [](double v) { return (std::bit_cast<std::uint64_t>(v) & 0xffffffff) == 0; });
    return static_cast<hsize_t>(rounded) > count - count / 10;
  }
  void dataset(std::string_view name, hid_t type, std::vector<hsize_t> size, const void* data) {
    const std::string what = place(name) + ": cannot be written";
    const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose, what);
    hsize_t count = 1;
    for (const auto n : size) count *= n;
    const Handle properties = timeless(H5P_DATASET_CREATE);
    if (size.size() == 1 && type == H5T_NATIVE_DOUBLE && is_coarse(static_cast<const double*>(data), count)) {
      const hsize_t chunk = 1 << 16;
      H5Pset_chunk(properties, 1, &chunk);
      H5Pset_shuffle(properties);
      H5Pset_deflate(properties, 1);
    }
    const Handle set(H5Dcreate2(group(), std::string(name).c_str(), type, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                     H5Dclose, what);
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
  void number(std::string_view name, double& v) override { scalar(name, H5T_NATIVE_DOUBLE, &v); }
  void integer(std::string_view name, std::int64_t& v) override { scalar(name, H5T_NATIVE_INT64, &v); }
  void text(std::string_view name, std::string& v) override { v = texts_in(name, 0).at(0); }
  void texts(std::string_view name, std::vector<std::string>& v) override { v = texts_in(name, 1); }
  void numbers(std::string_view name, std::vector<double>& v) override { entries(name, H5T_NATIVE_DOUBLE, v); }
  void integers(std::string_view name, std::vector<std::int64_t>& v) override { entries(name, H5T_NATIVE_INT64, v); }
  void bytes(std::string_view name, std::vector<std::uint8_t>& v) override { entries(name, H5T_NATIVE_UINT8, v); }
  void matrix(std::string_view name, Eigen::MatrixXd& v) override {
    const Handle set = open(name);
    const auto size = shape(set, 2, name);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows(size[0], size[1]);
    read(set, H5T_NATIVE_DOUBLE, rows.data(), size[0] * size[1], name);
    v = rows;
  }
  void matrices(std::string_view name, std::vector<Eigen::MatrixXd>& v) override {
    v.clear();
    if (is_group(name)) {
      std::size_t size = 0;
      return list(name, size, [&](std::size_t i) { matrix(std::to_string(i), v.emplace_back()); });
    }
    const Handle set = open(name);
    const auto size = shape(set, 3, name);
    std::vector<double> all(size[0] * size[1] * size[2]);
    read(set, H5T_NATIVE_DOUBLE, all.data(), all.size(), name);
    for (hsize_t i = 0; i < size[0]; ++i)
      v.emplace_back(Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
          all.data() + i * size[1] * size[2], static_cast<Eigen::Index>(size[1]), static_cast<Eigen::Index>(size[2])));
  }
  bool present(std::string_view name, bool) override {
    return H5Lexists(group(), std::string(name).c_str(), H5P_DEFAULT) > 0;
  }
  void enter(std::string_view name) override {
    const std::string what = place(name) + ": is missing";
    push(name, Handle(H5Gopen2(group(), std::string(name).c_str(), H5P_DEFAULT), H5Gclose, what));
  }

 private:
  void scalar(std::string_view name, hid_t type, void* data) {
    const Handle set = open(name);
    shape(set, 0, name);
    read(set, type, data, 1, name);
  }
  /// Texts of a dataset of no or one dimension.
  std::vector<std::string> texts_in(std::string_view name, int dimensions) {
    const Handle set = open(name);
    hsize_t count = 1;
    for (const auto n : shape(set, dimensions, name)) count *= n;
    const Handle kept(H5Dget_type(set), H5Tclose, place(name));
    if (H5Tget_class(kept) != H5T_STRING || H5Tis_variable_str(kept))
      throw std::runtime_error(place(name) + ": does not hold texts of fixed length");
    const std::size_t length = H5Tget_size(kept);
    std::string raw(length * count, '\0');
    read(set, text_type(length), raw.data(), count, name);
    std::vector<std::string> all;
    for (hsize_t i = 0; i < count; ++i) {
      const std::string padded = raw.substr(i * length, length);
      all.push_back(padded.substr(0, padded.find_last_not_of('\0') + 1));
    }
    return all;
  }
  bool is_group(std::string_view name) const {
    H5O_info_t info;
    return H5Oget_info_by_name(group(), std::string(name).c_str(), &info, H5P_DEFAULT) >= 0 &&
           info.type == H5O_TYPE_GROUP;
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
  void entries(std::string_view name, hid_t type, std::vector<T>& v) {
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
  void matrices(std::string_view name, std::vector<Eigen::MatrixXd>& v) override {
    enter(name);
    for (auto& m : v) matrix("", m);
    leave();
  }
  bool present(std::string_view name, bool value) override {
    std::int64_t there = value;
    integer(name, there);
    return value;
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

void write_hdf5(const std::string& path, const std::function<void(Archive&)>& visit) {
  std::string image;
  {
    Hdf5Writer archive(path, image);
    visit(archive);
    archive.finish();
  }
  write_file(path, image);
}

std::unique_ptr<Archive> hdf5_reader(const std::string& path) { return std::make_unique<Hdf5Reader>(path); }

namespace detail {

Columns::Column& Columns::column(std::string_view name) {
  for (auto& c : columns_)
    if (c.name == name) return c;
  return columns_.emplace_back(Column{std::string(name), "", {}, 0});
}

template <class T>
void Columns::cell(std::string_view name, T& value) {
  auto& c = column(name);
  if (stage_ == Stage::learn) c.cells = std::vector<T>();
  if (stage_ == Stage::collect) std::get<std::vector<T>>(c.cells).push_back(value);
  if (stage_ == Stage::hand_out) value = std::get<std::vector<T>>(c.cells).at(c.handed_out++);
}

void Columns::note(std::string_view member, std::string_view what, std::string_view text) {
  if (what == "unit") column(member).unit = text;
}

void Columns::visit(Archive& ar) {
  for (auto& c : columns_) std::visit([&](auto& cells) { ar(c.name, cells, c.unit); }, c.cells);
  for (const auto& c : columns_)
    if (std::visit([](const auto& cells) { return cells.size(); }, c.cells) != rows())
      throw std::runtime_error(
          fmt::format("the columns \"{}\" and \"{}\" of a file differ in length", columns_.front().name, c.name));
}

std::size_t Columns::rows() const {
  return columns_.empty() ? 0 : std::visit([](const auto& cells) { return cells.size(); }, columns_.front().cells);
}

void refuse_size(std::string_view name) {
  throw std::runtime_error(fmt::format("\"{}\" has another size than it must have", name));
}

void Columns::refuse() { throw std::logic_error("a row holds numbers and texts alone"); }

}  // namespace detail

Key content_key(const std::function<void(Archive&)>& visit) {
  HashArchive hash;
  visit(hash);
  return hash.key();
}

}  // namespace talkgraph
