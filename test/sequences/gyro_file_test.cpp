#include "sequences/gyro_file.h"

#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/temporary_directory.h"

namespace rotrocc {
namespace {

class GyroFileTest : public ::testing::Test {
 protected:
  std::string write(const std::string& text) const { return directory_.write("imu.csv", text); }

  TemporaryDirectory directory_;
};

TEST_F(GyroFileTest, ReadsTheLayoutOfEuroc) {
  const auto samples = readGyroFile(
      write("#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
            "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\r\n"
            "1403636579758555392,-0.099134701513277898,0.14730578886832138,0.02722713633111154,"
            "8.1476917083333333,-0.37592158333333331,-2.4026292499999999\r\n"
            "1403636579763555584,-0.099, 0.14, 0.029\r\n"));
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].stamp_ns, 1403636579758555392);
  EXPECT_EQ(samples[0].rate_rps,
            Eigen::Vector3d(-0.099134701513277898, 0.14730578886832138, 0.02722713633111154));
  EXPECT_EQ(samples[1].stamp_ns, 1403636579763555584);
}

TEST_F(GyroFileTest, NamesTheLineThatIsWrong) {
  expectError<std::runtime_error>([&] { readGyroFile(write("1,0,0,0\n2,0,0\n")); },
                                  "imu.csv:2: 3 columns");
  expectError<std::runtime_error>([&] { readGyroFile(write("1,0,0,nan\n")); },
                                  "imu.csv:1: 'nan' is not a finite number");
  expectError<std::runtime_error>([&] { readGyroFile(write("1e19,0,0,0\n")); },
                                  "'1e19' is not an integer below 9.2e18");
  expectError<std::runtime_error>([] { readGyroFile("/nowhere"); }, "cannot read /nowhere");
}

}  // namespace
}  // namespace rotrocc
