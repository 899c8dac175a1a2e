# SPDX-License-Identifier: Apache-2.0
# The Debian package, by CPack from three build folders side by side, one for each instruction set (./run package). What the program
# needs is found by dpkg-shlibdeps.
install(FILES cmake/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_INSTALL_CMAKE_PROJECTS)
foreach(isa baseline avx2 avx512)
  list(APPEND CPACK_INSTALL_CMAKE_PROJECTS ${CMAKE_BINARY_DIR}/../${isa} patency ALL /)
endforeach()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME patency)
set(CPACK_PACKAGE_CONTACT "patency developers")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "blood flow and stents in coronary arteries by particle methods")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "Computes the blood flow in the lumen of a patient's coronary artery:
pressures, fractional flow reserve, flow split, wall shear stress. Implants
a stent in it, computes the flow after, and says on one page what has
changed. A case is a text file with units.
For research; not a medical device.")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
include(CPack)
