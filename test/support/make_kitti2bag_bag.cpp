// Makes a bag as kitti2bag does, for tests: make_kitti2bag_bag SEQUENCE_DIR OUT.bag raw|odometry

#include <exception>
#include <iostream>
#include <string>

#include "support/kitti2bag_writer.h"

int main(int argc, char** argv) {
  const std::string kind = argc == 4 ? argv[3] : "";
  if (kind != "raw" && kind != "odometry") {
    std::cerr << "usage: make_kitti2bag_bag SEQUENCE_DIR OUT.bag raw|odometry\n";
    return 2;
  }
  try {
    const rotrocc::KittiSequence sequence(argv[1]);
    if (kind == "raw") {
      rotrocc::writeKitti2bagRaw(sequence, argv[2]);
    } else {
      rotrocc::writeKitti2bagOdometry(sequence, argv[2]);
    }
  } catch (const std::exception& error) {
    std::cerr << "make_kitti2bag_bag: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
