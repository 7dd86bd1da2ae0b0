#include "orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using brume::anatomical_code;

TEST(Orientation, CodesOfAxes)
{
  EXPECT_EQ(anatomical_code({ { 1, 0, 0, 0, 1, 0, 0, 0, 1 } }), "RAS");
  EXPECT_EQ(anatomical_code({ { -1, 0, 0, 0, -1, 0, 0, 0, 1 } }), "LPS");
  // i runs upward, j to the right, k to the front.
  EXPECT_EQ(anatomical_code({ { 0, 1, 0, 0, 0, 1, 1, 0, 0 } }), "SRA");
  EXPECT_EQ(anatomical_code({ { 0, 0, -1, 1, 0, 0, 0, -1, 0 } }), "AIL");
}

TEST(Orientation, CodesOfObliqueAxesNameNoDirectionTwice)
{
  const double c = std::cos(0.8), s = std::sin(0.8); // past 45 degrees is 0.785
  EXPECT_EQ(anatomical_code({ { c, -s, 0, s, c, 0, 0, 0, 1 } }), "ALS");
  const double r = 1 / std::sqrt(3.0);
  const std::string code = anatomical_code({ { r, r, r, r, r, r, r, r, r } });
  EXPECT_EQ(code, "RAS");
}

TEST(Orientation, RejectsWhatIsNoFrame)
{
  const std::array<long long, 3> n{ { 2, 2, 2 } };
  EXPECT_THROW(brume::frame_of_affine({ { 1, 0, 0, 0, 0, NAN, 0, 0, 0, 0, 1, 0 } }, n),
    std::invalid_argument);
  EXPECT_THROW(brume::frame_of_affine({ { 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0 } }, n),
    std::invalid_argument);
  EXPECT_THROW(brume::frame_of_affine({ { 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0 } }, n),
    std::invalid_argument);
  EXPECT_THROW(brume::frame_of_affine({ { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, INFINITY } }, n),
    std::invalid_argument);
}
