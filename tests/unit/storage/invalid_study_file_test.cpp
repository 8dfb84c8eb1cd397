// Tests of read_study() with invalid files: each is rejected with a specific message and left unchanged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "engine/storage/file_header.hpp"
#include "engine/storage/study_file.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using test::Folder;
using test::slurp;
using test::spill;
using test::storage_error;
using ::testing::HasSubstr;

TEST(InvalidStudyFile, IsMissing) {
  const Folder folder;
  const std::string path = folder / "none.h5";
  EXPECT_EQ(storage_error([&] { read_study(path); }), path + ": cannot be opened (No such file or directory)");
}

TEST(InvalidStudyFile, IsAFolder) {
  const Folder folder;
  EXPECT_EQ(storage_error([&] { read_study(folder.path()); }), folder.path() + ": cannot be read (Is a directory)");
}

TEST(InvalidStudyFile, IsEmpty) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  spill(path, "");
  EXPECT_EQ(storage_error([&] { read_study(path); }), path + ": the file is empty");
}

TEST(InvalidStudyFile, IsATextFile) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  spill(path, "[study]\nname = \"a TOML file\"\n");
  EXPECT_EQ(storage_error([&] { read_study(path); }),
            path + ": not a pkmopt study (neither a pkmopt header nor HDF5 data)");
}

TEST(InvalidStudyFile, IsAnHdf5FileOfAnotherProgram) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  write_study(path, StudyContents{});
  const std::string hdf5 = slurp(path).substr(kHeaderBytes);
  const std::string expected = path + ": an HDF5 file, but not a pkmopt study (no pkmopt header)";
  spill(path, hdf5);
  EXPECT_EQ(storage_error([&] { read_study(path); }), expected);
  spill(path, std::string(2048, 'x') + hdf5);
  EXPECT_EQ(storage_error([&] { read_study(path); }), expected);
}

TEST(InvalidStudyFile, HasANewerSchema) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  write_study(path, StudyContents{});
  std::string bytes = slurp(path);
  seal(bytes, kStudySchema + 1);
  spill(path, bytes);
  EXPECT_EQ(storage_error([&] { read_study(path); }),
            path + ": written with study schema 6, but this program reads schemas up to 5; use a newer pkmopt");
  EXPECT_EQ(slurp(path), bytes);
}

TEST(InvalidStudyFile, HasADamagedSchemaNumber) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  write_study(path, StudyContents{});
  for (const char digit : {'0', '1', '2', '3', '4', '6'}) {
    std::string bytes = slurp(path);
    bytes[bytes.find("schema=5") + 7] = digit;
    spill(folder / "other.h5", bytes);
    EXPECT_THAT(storage_error([&] { read_study(folder / "other.h5"); }), HasSubstr(": the file is damaged")) << digit;
  }
}

TEST(InvalidStudyFile, IsAPipeAndDoesNotBlock) {
  const Folder folder;
  const std::string path = folder / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  EXPECT_EQ(storage_error([&] { read_study(path); }), path + ": is a pipe or a device; expected a regular file");
}

TEST(InvalidStudyFile, IsHugeAndRecognisedByItsBeginning) {
  const Folder folder;
  const std::string path = folder / "huge.h5";
  spill(path, "");
  ASSERT_EQ(::truncate(path.c_str(), off_t{1} << 40), 0);  // a sparse file of 1 TiB
  EXPECT_EQ(storage_error([&] { read_study(path); }),
            path + ": not a pkmopt study (neither a pkmopt header nor HDF5 data)");
}

TEST(InvalidStudyFile, IsTruncatedAnywhere) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  write_study(path, test::sample_study());
  const std::string bytes = slurp(path);
  for (std::size_t size = 1; size < bytes.size(); size += size < 600 ? 1 : 997) {
    spill(path, bytes.substr(0, size));
    EXPECT_THAT(storage_error([&] { read_study(path); }), HasSubstr(path + ": the file is truncated")) << size;
  }
  spill(path, bytes.substr(0, bytes.size() - 1));
  EXPECT_EQ(storage_error([&] { read_study(path); }), path + ": the file is truncated (" +
                                                          std::to_string(bytes.size() - 513) + " of " +
                                                          std::to_string(bytes.size() - 512) + " bytes)");
}

TEST(InvalidStudyFile, HasAnyByteDamaged) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  write_study(path, test::sample_study());
  const std::string bytes = slurp(path);
  for (std::size_t at = 0; at < bytes.size(); at += at < 600 ? 1 : 211) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x41);
    spill(path, damaged);
    EXPECT_NE(storage_error([&] { read_study(path); }), "") << "byte " << at;
    EXPECT_EQ(slurp(path), damaged);
  }
}

TEST(InvalidStudyFile, IsReportedAsDamaged) {
  const Folder folder;
  const std::string path = folder / "s.h5";
  write_study(path, test::sample_study());
  const std::string bytes = slurp(path);
  std::string damaged = bytes;
  damaged[bytes.size() / 2] ^= 1;
  spill(path, damaged);
  EXPECT_EQ(storage_error([&] { read_study(path); }),
            path + ": the file is damaged or was changed by another program (its checksum differs)");
  damaged = bytes;
  damaged[500] = '!';
  spill(path, damaged);
  EXPECT_EQ(storage_error([&] { read_study(path); }),
            path + ": the file is damaged (its header, the first 512 bytes, is invalid)");
  spill(path, bytes + "more");
  EXPECT_THAT(storage_error([&] { read_study(path); }), HasSubstr("its checksum differs"));
}

}  // namespace
}  // namespace pkm
