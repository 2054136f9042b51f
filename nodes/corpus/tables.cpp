#include "nodes/corpus/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "graph/archive.h"
#include "nodes/corpus/text.h"

namespace talkgraph {
namespace {

namespace fs = std::filesystem;
static_assert(std::endian::native == std::endian::little, ".npy files are read as little-endian");

/// No cell is a number.
bool is_header(const std::vector<std::string>& cells) {
  return std::none_of(cells.begin(), cells.end(), [](const auto& cell) { return number_of(cell).has_value(); });
}

double number_or_nan(const std::string& cell, const std::string& path, int line) {
  const auto value = number_of(cell);
  return value && std::isnan(*value) ? *value : number_in(cell, path, line);
}

/// The value of a key of the Python dictionary that heads a .npy file.
std::string header_value(const std::string& header, const std::string& key, const std::string& path) {
  const auto at = header.find("'" + key + "':");
  if (at == std::string::npos) throw std::runtime_error(path + ": its header does not say " + key);
  const auto from = header.find_first_not_of(' ', at + key.size() + 3);
  const auto to = header[from] == '(' ? header.find(')', from) + 1 : header.find(',', from);
  return header.substr(from, to - from);
}

std::pair<Eigen::Index, Eigen::Index> shape_of(const std::string& tuple, const std::string& path) {
  std::vector<Eigen::Index> sizes;
  for (const auto& part : split(tuple.substr(1, tuple.size() - 2), ','))
    if (part.find_first_of("0123456789") != std::string::npos)
      sizes.push_back(static_cast<Eigen::Index>(number_in(part, path, 1)));
  if (sizes.empty() || sizes.size() > 2)
    throw std::runtime_error(fmt::format("{}: has the shape {}; frames x dimensions is expected", path, tuple));
  return {sizes[0], sizes.size() == 2 ? sizes[1] : 1};
}

template <class T>
Eigen::MatrixXd matrix_of(const char* data, Eigen::Index rows, Eigen::Index columns) {
  Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(rows, columns);
  if (values.size() > 0) std::memcpy(values.data(), data, static_cast<std::size_t>(values.size()) * sizeof(T));
  return values.template cast<double>();
}

}  // namespace

NumberTable read_csv(const std::string& path) {
  const auto lines = lines_of(read_text_file(path));
  NumberTable table;
  const auto head = lines.empty() ? std::vector<std::string>{} : split(lines[0].text, ',');
  if (is_header(head)) table.names = head;
  const std::size_t first = table.names.empty() ? 0 : 1, columns = head.size();
  if (lines.size() == first) throw std::runtime_error(path + ": holds no numbers");
  table.values.resize(std::ssize(lines) - static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(columns));
  for (std::size_t i = first; i < lines.size(); ++i) {
    const auto cells = split(lines[i].text, ',');
    table.lines.push_back(lines[i].number);
    if (cells.size() != columns)
      complain(path, lines[i].number, fmt::format("{} columns are expected, got {}", columns, cells.size()));
    for (std::size_t c = 0; c < columns; ++c)
      table.values(static_cast<Eigen::Index>(i - first), static_cast<Eigen::Index>(c)) =
          number_or_nan(cells[c], path, lines[i].number);
  }
  return table;
}

Eigen::MatrixXd read_npy(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": is missing or cannot be read");
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (bytes.size() < 12 || !bytes.starts_with("\x93NUMPY")) throw std::runtime_error(path + ": is not a .npy file");
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i])); };
  const bool small = bytes[6] == 1;  // version 1 has a two-byte header length
  const std::size_t head = small ? 10 : 12;
  const std::size_t length = byte(8) | byte(9) << 8 | (small ? 0 : byte(10) << 16 | byte(11) << 24);
  if (head + length > bytes.size()) throw std::runtime_error(path + ": breaks off within its header");
  const std::string header = bytes.substr(head, length);
  const std::string type = header_value(header, "descr", path);
  if (type != "'<f4'" && type != "'<f8'")
    throw std::runtime_error(fmt::format("{}: holds {}; save it as float32 or float64", path, type));
  if (header_value(header, "fortran_order", path) != "False")
    throw std::runtime_error(path + ": is in Fortran order; save numpy.ascontiguousarray(...) of it");
  const auto [rows, columns] = shape_of(header_value(header, "shape", path), path);
  const std::size_t size = type == "'<f4'" ? 4 : 8;
  const std::size_t there = (bytes.size() - head - length) / size;
  if (columns != 0 && there / static_cast<std::size_t>(columns) < static_cast<std::size_t>(rows))
    throw std::runtime_error(
        fmt::format("{}: breaks off: {} x {} numbers are promised, {} are there", path, rows, columns, there));
  const char* data = bytes.data() + head + length;
  return size == 4 ? matrix_of<float>(data, rows, columns) : matrix_of<double>(data, rows, columns);
}

NumberTable read_table(const std::string& path, const std::string& dataset) {
  const std::string ending = lower_case(fs::path(path).extension().string());
  NumberTable table;
  if (ending == ".csv")
    table = read_csv(path);
  else if (ending == ".npy")
    table.values = read_npy(path);
  else if (ending == ".h5" || ending == ".hdf5")
    (*hdf5_reader(path))(dataset, table.values);
  else
    throw std::runtime_error(path + ": a track is read from .csv, .npy, .h5 and .hdf5 files");
  if (table.values.size() == 0) throw std::runtime_error(path + ": holds no numbers");
  for (Eigen::Index t = 0; t < table.values.rows(); ++t) {
    if (table.values.row(t).allFinite()) continue;
    const auto what = fmt::format("frame {} holds a number that is not finite", t);
    if (table.lines.empty()) throw std::runtime_error(path + ": " + what);
    complain(path, table.lines[static_cast<std::size_t>(t)], what);
  }
  return table;
}

}  // namespace talkgraph
