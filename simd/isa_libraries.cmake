# The kernels, compiled once per instruction set: fastccd_add_isa_kernels(TARGET) adds the objects.

include(CheckCXXCompilerFlag)

function(fastccd_add_isa_kernels target)
  set(portable scalar)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    set(wide sse2)
    target_compile_definitions(${target} PRIVATE FASTCCD_HAVE_X86)
    if(FASTCCD_AVX)
      list(APPEND wide avx2)
      target_compile_definitions(${target} PRIVATE FASTCCD_HAVE_AVX2)
      if(FASTCCD_AVX512)
        list(APPEND wide avx512)
        target_compile_definitions(${target} PRIVATE FASTCCD_HAVE_AVX512)
      endif()
    endif()
  elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64|ARM64)$")
    set(wide neon)
    target_compile_definitions(${target} PRIVATE FASTCCD_HAVE_NEON)
  endif()
  set(arch_sse2 sse2)
  set(arch_avx2 avx2)
  set(arch_avx512 avx512bw)
  set(arch_neon neon64)
  set(flags_avx2 -mavx2)
  # xsimd's avx512bw batches need the whole family; avx512dq alone is not pulled in by the others.
  set(flags_avx512 -mavx512f -mavx512cd -mavx512dq -mavx512bw)

  set(optimised -O3)
  if(FASTCCD_SANITIZE)
    # Functions are inlined as compilers see fit. Where each access is checked, whole stages as one function take them minutes: a kernel for AVX2
    # takes clang 14 with AddressSanitizer 38 s so instead of 205, g++ 12 with ThreadSanitizer some 30 instead of 116. Tests of kernels run up to
    # two and a half times as long. What instruction sets share is emitted for any of them: such builds are for the machine that makes them.
    set(optimised -O2)
    set(inlining FASTCCD_INLINE=inline FASTCCD_INLINE_LAMBDA=)
  endif()

  # More than any function here comes to. Not large-function-growth: at 1,000,000 % g++ 12 refuses long functions again (an overflow, it seems).
  set(inline_limits --param=large-function-insns=100000000 --param=large-stack-frame=100000000)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    check_cxx_compiler_flag("${inline_limits}" FASTCCD_GNU_INLINE_LIMITS)  # they may change from version to version
  endif()

  foreach(isa IN LISTS portable wide)
    add_library(fastccd_${isa} OBJECT ${PROJECT_SOURCE_DIR}/simd/vertex_face_kernels.cpp ${PROJECT_SOURCE_DIR}/simd/edge_edge_kernels.cpp
      ${PROJECT_SOURCE_DIR}/simd/isa_kernels.cpp)
    target_include_directories(fastccd_${isa} PRIVATE
      ${PROJECT_SOURCE_DIR}/kernels/include ${PROJECT_SOURCE_DIR}/kernels ${PROJECT_SOURCE_DIR}/simd)
    target_compile_definitions(fastccd_${isa} PRIVATE
      FASTCCD_KERNEL_ISA=${isa} FASTCCD_KERNEL_NAMESPACE=${isa}_lanes ${inlining})
    if(DEFINED arch_${isa})
      target_compile_definitions(fastccd_${isa} PRIVATE FASTCCD_KERNEL_ARCH=${arch_${isa}})
      target_link_libraries(fastccd_${isa} PRIVATE xsimd)
    endif()
    # The kernels are optimised in every build type: without inlining they would be useless, and functions shared between instruction sets
    # would be emitted.
    target_compile_options(fastccd_${isa} PRIVATE ${optimised} ${flags_${isa}})
    # Whatever is linked before them: with functions at multiples of 16, packed scenes took up to 8 % longer in one program than in another.
    target_compile_options(fastccd_${isa} PRIVATE -falign-functions=64 -falign-loops=64)
    target_link_libraries(fastccd_${isa} PRIVATE fastccd_warnings fastccd_arithmetic fastccd_coverage)
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      # Fewer registers in use at a time in the long straight lines of the certificates: up to 4 % faster, none slower.
      target_compile_options(fastccd_${isa} PRIVATE -flive-range-shrinkage)
      # However long the caller, small functions are inlined into it where it is first looked at. At the ordinary limits most of those of xsimd
      # are left to the inliner of the whole unit: g++ 12 takes 1.5 to 2 times as long then, for code that is 0.2 to 1.4 % longer (with AVX2,
      # random pairs and scenes execute up to 0.2 % more or fewer instructions).
      if(FASTCCD_GNU_INLINE_LIMITS)
        target_compile_options(fastccd_${isa} PRIVATE ${inline_limits})
      endif()
    endif()
    if(isa STREQUAL avx512 AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      # g++ 12 takes the deliberately undefined operand of its own AVX-512 intrinsics for a mistake (GCC bug 105593).
      target_compile_options(fastccd_${isa} PRIVATE -Wno-uninitialized -Wno-maybe-uninitialized)
    endif()
    set_target_properties(fastccd_${isa} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden UNITY_BUILD OFF)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:fastccd_${isa}>)
  endforeach()
endfunction()
