# Installs the build, and configures, builds and runs a project that finds it there.
#   cmake -DBUILD=… -DSOURCE=…/package -DWORK=… -DGENERATOR=Ninja -DC_COMPILER=… -DCXX_COMPILER=… -P check_package.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${WORK})
# The build's own list of what it installed is not this test's to write.
set(manifest ${BUILD}/install_manifest.txt)
if(EXISTS ${manifest})
    file(RENAME ${manifest} ${manifest}.kept)
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix OUTPUT_QUIET RESULT_VARIABLE installed)
file(REMOVE ${manifest})
if(EXISTS ${manifest}.kept)
    file(RENAME ${manifest}.kept ${manifest})
endif()
if(NOT installed EQUAL 0)
    message(FATAL_ERROR "the install failed")
endif()
# Away from where it was installed: a package that is moved must still be found.
file(RENAME ${WORK}/prefix ${WORK}/moved)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/consumer -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release
                        -DCMAKE_PREFIX_PATH=${WORK}/moved -DCMAKE_C_COMPILER=${C_COMPILER}
                        -DCMAKE_CXX_COMPILER=${CXX_COMPILER} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${WORK}/consumer COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${WORK}/consumer/consumer_cxx COMMAND_ERROR_IS_FATAL ANY)
foreach(picture sky.png sky.exr)
    execute_process(COMMAND ${WORK}/consumer/consumer_c ${WORK}/${picture} COMMAND_ERROR_IS_FATAL ANY)
    if(NOT EXISTS ${WORK}/${picture})
        message(FATAL_ERROR "${picture} was not written")
    endif()
endforeach()
# The command finds its library too.
if(EXISTS ${WORK}/moved/bin/triptych)
    execute_process(COMMAND ${WORK}/moved/bin/triptych methods OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
endif()
file(REMOVE_RECURSE ${WORK})
