#include "pirouette/trial/trace_file.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <stdexcept>

namespace pirouette {
namespace {

namespace fs = std::filesystem;

/// What NumPy would see in a file: its header's text, its columns and the bytes of its rows.
struct NpyFile {
  struct Column {
    std::string dtype;
    std::string shape;
    std::size_t offset = 0;  ///< in a row
    std::size_t size = 0;    ///< bytes
  };

  std::string header;
  std::size_t prefix_and_header = 0;
  std::vector<std::pair<std::string, Column>> columns;
  std::size_t row_size = 0;
  std::size_t rows = 0;
  std::string data;

  const Column& column(const std::string& name) const {
    for (const auto& [key, value] : columns) {
      if (key == name) return value;
    }
    throw std::out_of_range(name);
  }

  template <class T>
  T value(std::size_t row, const std::string& name, std::size_t element = 0) const {
    T out;
    const std::size_t at = row * row_size + column(name).offset + element * sizeof(T);
    std::memcpy(&out, data.data() + at, sizeof(T));
    return out;
  }
};

NpyFile read_npy(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  NpyFile npy;
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const auto length = static_cast<std::size_t>(static_cast<unsigned char>(bytes[8])) +
                      256 * static_cast<std::size_t>(static_cast<unsigned char>(bytes[9]));
  npy.prefix_and_header = 10 + length;
  npy.header = bytes.substr(10, length);
  npy.data = bytes.substr(npy.prefix_and_header);

  const std::regex column(R"(\('(\w+)', '([<|])([fib])(\d)'(?:, \(([\d, ]+)\))?\))");
  for (std::sregex_iterator it(npy.header.begin(), npy.header.end(), column), end; it != end;
       ++it) {
    const std::smatch& m = *it;
    NpyFile::Column c{m[2].str() + m[3].str() + m[4].str(), m[5].str(), npy.row_size, 0};
    c.size = std::stoul(m[4].str());
    const std::regex number(R"(\d+)");
    const std::string shape = m[5].str();
    for (std::sregex_iterator n(shape.begin(), shape.end(), number); n != end; ++n) {
      c.size *= std::stoul(n->str());
    }
    npy.row_size += c.size;
    npy.columns.emplace_back(m[1].str(), c);
  }
  std::smatch shape;
  EXPECT_TRUE(std::regex_search(npy.header, shape, std::regex(R"('shape': \((\d+),\))")));
  npy.rows = std::stoul(shape[1].str());
  return npy;
}

class TraceFileTest : public testing::Test {
 protected:
  void SetUp() override {
    path_ = fs::path(testing::TempDir()) /
            (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".npy");
  }
  void TearDown() override { fs::remove(path_); }

  NpyFile write_rows(int count) {
    Result<NpyRowsFile> file = create_trace_file(path_);
    EXPECT_TRUE(file.ok());
    for (int i = 0; i < count; ++i) {
      TickTrace tick;
      tick.sensors.time = 0.01 * i;
      tick.status = ControllerStatus::kWalking;
      tick.sensors.joint_position[Leg::kRL] = Vec3(i, i + 0.25, i + 0.5);
      tick.contacts[Leg::kFL].in_contact = true;
      PlantTruth truth;
      truth.p_WG = Vec3(1.0, 2.0, 3.0 + i);
      truth.f_W[Leg::kRR].z() = 22.0;
      truth.contact[Leg::kRR] = true;
      file.value().append(TraceRow{tick, truth, 7.5});
    }
    EXPECT_FALSE(file.value().finish());
    return read_npy(path_);
  }

  fs::path path_;
};

TEST_F(TraceFileTest, ReadsBackWhatWasWritten) {
  const NpyFile npy = write_rows(3);
  ASSERT_EQ(npy.rows, 3u);
  for (std::size_t row = 0; row < 3; ++row) {
    const auto i = static_cast<double>(row);
    EXPECT_EQ(npy.value<double>(row, "time"), 0.01 * i);
    EXPECT_EQ(npy.value<int>(row, "status"), 1);
    EXPECT_EQ(npy.value<double>(row, "joint_position", 10), i + 0.25);
    EXPECT_EQ(npy.value<char>(row, "contact", 0), 0);
    EXPECT_EQ(npy.value<char>(row, "contact", 1), 1);
    EXPECT_EQ(npy.value<double>(row, "true_com_position", 2), 3.0 + i);
    EXPECT_EQ(npy.value<double>(row, "true_rpy", 2), 7.5);
    EXPECT_EQ(npy.value<double>(row, "true_foot_force", 8), 22.0);
    EXPECT_EQ(npy.value<char>(row, "true_contact", 2), 1);
  }
}

TEST_F(TraceFileTest, KeepsTheFormatsPromises) {
  const NpyFile npy = write_rows(2);
  EXPECT_EQ(npy.prefix_and_header % 64, 0u);
  EXPECT_EQ(npy.header.back(), '\n');
  EXPECT_NE(npy.header.find("'fortran_order': False"), std::string::npos);
  EXPECT_EQ(npy.data.size(), npy.rows * npy.row_size);
  EXPECT_EQ(npy.column("time").dtype, "<f8");
  EXPECT_EQ(npy.column("time").shape, "");
  EXPECT_EQ(npy.column("status").dtype, "<i4");
  EXPECT_EQ(npy.column("contact").dtype, "|b1");
  EXPECT_EQ(npy.column("contact").shape, "4,");
  EXPECT_EQ(npy.column("psp_weight").shape, "4,");
  EXPECT_EQ(npy.column("path_position").shape, "2,");
  EXPECT_EQ(npy.column("joint_position").shape, "4, 3");
}

TEST_F(TraceFileTest, WithoutRowsIsAnEmptyArray) {
  const NpyFile npy = write_rows(0);
  EXPECT_EQ(npy.rows, 0u);
  EXPECT_TRUE(npy.data.empty());
}

TEST_F(TraceFileTest, NamesEveryColumnOnceAndDocumentsIt) {
  const NpyFile npy = write_rows(1);
  const std::string table = trace_markdown();
  std::set<std::string> names;
  for (const auto& [name, column] : npy.columns) {
    EXPECT_TRUE(names.insert(name).second) << name << " twice";
    EXPECT_NE(table.find("| `" + name + "` | " + column.dtype.substr(1)), std::string::npos)
        << name;
  }
  EXPECT_GT(names.size(), 50u);
}

TEST(TraceFile, ThatCannotBeCreatedIsAnError) {
  const Result<NpyRowsFile> file = create_trace_file("/no/such/folder/trace.npy");
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.errors().front().file, "/no/such/folder/trace.npy");
}

TEST(TraceFile, OnAFullDiskIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_FALSE(create_trace_file("/dev/full").ok());
}

}  // namespace
}  // namespace pirouette
