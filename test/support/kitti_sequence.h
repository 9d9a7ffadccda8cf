#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "files/image_file.h"
#include "files/text_file.h"
#include "rotrocc/stereo_camera.h"
#include "rotrocc/stereo_pair.h"
#include "rotrocc/trajectory.h"

namespace rotrocc {

/// A complete sequence of the KITTI benchmark, read without ROS.
struct KittiSequence {
  std::string directory;
  std::vector<std::int64_t> stamps_ns = readTimes(directory + "/times.txt");
  StereoCamera camera = {};

  explicit KittiSequence(const std::string& name) : directory(name) {
    const std::vector<TextLine> lines = readTextLines(directory + "/calib.txt");
    const cv::Mat first = pair(0).left;
    camera.width = first.cols;
    camera.height = first.rows;
    camera.fx = lines[0].number(1);
    camera.fy = lines[0].number(6);
    camera.cx = lines[0].number(3);
    camera.cx_right = lines[1].number(3);
    camera.cy = lines[0].number(7);
    camera.baseline_m = (lines[0].number(4) - lines[1].number(4)) / camera.fx;
  }

  int size() const { return static_cast<int>(stamps_ns.size()); }

  StereoPair pair(int index) const {
    const std::string name = cv::format("/%06d.png", index);
    return {stamps_ns.at(static_cast<std::size_t>(index)),
            readGrayImage(directory + "/image_0" + name),
            readGrayImage(directory + "/image_1" + name)};
  }
};

}  // namespace rotrocc
