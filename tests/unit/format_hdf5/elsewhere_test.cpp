// Files that lead elsewhere or claim more than they hold are refused with a message, before memory is asked for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include "formats/hdf5/foreign.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::h5::format_hdf5_elsewhere_test {
namespace {

using testing::HasSubstr;

// A file of this suite's kind with an external link, a soft link to it, a virtual dataset, one in external storage and
// one of 4e8 packed zeros.
void write_hostile(const std::string& path, const std::string& other) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  ASSERT_GE(file, 0);
  auto make = [&](const char* name, hsize_t count, hid_t create) {
    const hid_t space = H5Screate_simple(1, &count, nullptr), unit = H5Tcopy(H5T_C_S1), one = H5Screate(H5S_SCALAR);
    const hid_t d = H5Dcreate2(file, name, H5T_STD_U32LE, space, H5P_DEFAULT, create, H5P_DEFAULT);
    ASSERT_GE(d, 0) << name;
    H5Tset_cset(unit, H5T_CSET_UTF8), H5Tset_strpad(unit, H5T_STR_NULLPAD);
    const hid_t a = H5Acreate2(d, "units", unit, one, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(a, unit, "1");
    H5Aclose(a), H5Dclose(d), H5Sclose(space), H5Sclose(one), H5Tclose(unit);
  };
  const hid_t packed = H5Pcreate(H5P_DATASET_CREATE), external = H5Pcreate(H5P_DATASET_CREATE),
              joined = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 4 << 20, all = 4, claimed = 400'000'000;
  H5Pset_chunk(packed, 1, &chunk), H5Pset_shuffle(packed), H5Pset_deflate(packed, 9);
  H5Pset_fill_time(packed, H5D_FILL_TIME_ALLOC), H5Pset_alloc_time(packed, H5D_ALLOC_TIME_EARLY);
  H5Pset_external(external, other.c_str(), 0, 16);
  const hid_t space = H5Screate_simple(1, &all, nullptr);
  H5Pset_virtual(joined, space, other.c_str(), "/values", space);
  const hid_t whole = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_alloc_time(whole, H5D_ALLOC_TIME_EARLY);
  make("honest", 4, whole);
  H5Pclose(whole);
  make("claims", claimed, packed);
  make("stored_elsewhere", 4, external);
  make("joined", 4, joined);
  H5Lcreate_external(other.c_str(), "/values", file, "linked", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_external(other.c_str(), "/", file, "group", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_soft("/linked", file, "soft", H5P_DEFAULT, H5P_DEFAULT);
  H5Sclose(space), H5Pclose(packed), H5Pclose(external), H5Pclose(joined), H5Fclose(file), H5Pclose(access);
}

class Hostile : public testing::Test {
 protected:
  void SetUp() override {
    other_ = folder_ / "other.h5", path_ = folder_ / "hostile.h5";
    Writer w(other_, other_);
    w.put("/values", std::vector<uint32_t>{1, 2, 3, 4}, "1");
    w.close();
    write_hostile(path_, other_);
  }
  std::string of_reader(const std::string& name) {
    return message_of([&] { Reader(path_).get<uint32_t>(name, "1"); });
  }
  std::string of_foreign(const std::string& name) {
    return message_of([&] { Foreign(path_).table(name); });
  }
  TempFolder folder_;
  std::string path_, other_;
};

TEST_F(Hostile, ValuesElsewhereAreNotFollowed) {
  EXPECT_EQ(of_reader("/honest"), "no error");
  EXPECT_EQ(of_foreign("/honest"), "no error");
  for (const auto& message : {of_reader("/linked"), of_foreign("/linked"), of_foreign("/group/values")})
    EXPECT_THAT(message, HasSubstr("is a link into another file, which is not followed"));
  for (const auto& message : {of_reader("/soft"), of_foreign("/soft")}) EXPECT_NE(message, "no error");
  for (const auto& message : {of_reader("/stored_elsewhere"), of_foreign("/stored_elsewhere")})
    EXPECT_THAT(message, HasSubstr("keeps its values in another file"));
  for (const auto& message : {of_reader("/joined"), of_foreign("/joined")})
    EXPECT_THAT(message, HasSubstr("a virtual dataset"));
}

TEST_F(Hostile, ClaimsAreHeldAgainstTheFile) {
  EXPECT_THAT(of_reader("/claims"), HasSubstr("more than 256 times"));
  EXPECT_NE(of_foreign("/claims"), "no error");
}

}  // namespace
}  // namespace suite::h5::format_hdf5_elsewhere_test
