# The matchers beside OpenCV's own calls; run it without arguments for the whole table.
add_executable(matchers matchers.cpp)
target_link_libraries(matchers PRIVATE
  stereovox::stereo stereovox_build_options fmt::fmt CLI11::CLI11 opencv_calib3d opencv_imgproc)
