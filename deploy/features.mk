# What follows from what this machine has (deploy/probe.sh). A source that needs a missing library is left out and its
# twin *_stub.c, which says what to install, is built in its place. Heavy libraries (OpenCV, torch, MPI) are only in
# modules, build/lib/vsss_NAME.so, which a command loads when it needs them.
$(shell sh deploy/probe.sh build)
include build/features.mk

FEATURE_CFLAGS :=
FEATURE_LIBS := -lmujoco
FEATURE_EXCLUDE :=
FEATURE_OBJ :=
GENERATED :=
MODULES :=
EXTRA_ALL :=

# $(call choose,NAME,real.c): builds real.c where the feature is there, real_stub.c where it is not.
choose = $(if $(HAVE_$(1)),$(2:.c=_stub.c),$(2))

# LCM: lcm_types/NAME.lcm holds struct NAME of package vsss; lcm-gen makes build/gen/lcm/vsss_NAME.{c,h}.
FEATURE_EXCLUDE += $(call choose,LCM,src/comms/bus.c)
LCM_SRC := src/comms/bus_encode.c src/comms/bus_decode.c src/comms/tick.c
FEATURE_EXCLUDE += $(if $(HAVE_LCM),,$(LCM_SRC))
ifneq ($(HAVE_LCM),)
LCM_TYPES := $(wildcard lcm_types/*.lcm)
LCM_NAMES := $(LCM_TYPES:lcm_types/%.lcm=vsss_%)
FEATURE_LIBS += -llcm
FEATURE_OBJ += $(LCM_NAMES:%=$(B)/gen/lcm/%.o)
GENERATED += $(if $(LCM_TYPES),build/gen/lcm/.made)
build/gen/lcm/.made: $(LCM_TYPES)
	@mkdir -p $(@D)
	@echo '  LCM   $(LCM_TYPES)'
	$(Q)lcm-gen -c --c-cpath $(@D) --c-hpath $(@D) $(LCM_TYPES)
	@touch $@
$(LCM_NAMES:%=build/gen/lcm/%.c): build/gen/lcm/.made ;
# Generated code is not clean under -Wextra, and is not ours to mend (it copies nothing from and to NULL, too).
$(B)/gen/lcm/%.o: build/gen/lcm/%.c
	@mkdir -p $(@D)
	$(Q)$(CC) -std=gnu11 -w $(OPT) -fPIC -fvisibility=hidden $(SAN) $(if $(SAN),-fno-sanitize=nonnull-attribute) $(CPPFLAGS) $(CFLAGS) -c -o $@ $<
$(LCM_SRC:%.c=$(B)/%.o): build/gen/lcm/.made
endif

# The league's datagrams: src/league_net/NAME.proto; protoc-c makes build/gen/league/NAME.pb-c.{c,h}.
FEATURE_EXCLUDE += $(call choose,PROTOBUFC,src/league_net/messages.c) $(call choose,PROTOBUFC,src/league_net/ssl_messages.c)
ifneq ($(HAVE_PROTOBUFC),)
PROTO_SRC := $(wildcard src/league_net/*.proto)
PROTO_NAMES := $(PROTO_SRC:src/league_net/%.proto=%)
FEATURE_LIBS += -lprotobuf-c
FEATURE_OBJ += $(PROTO_NAMES:%=$(B)/gen/league/%.pb-c.o)
GENERATED += build/gen/league/.made
build/gen/league/.made: $(PROTO_SRC)
	@mkdir -p $(@D)
	@echo '  PROTO $(PROTO_SRC)'
	$(Q)protoc-c --c_out=$(@D) --proto_path=src/league_net $(PROTO_SRC)
	@touch $@
$(PROTO_NAMES:%=build/gen/league/%.pb-c.c): build/gen/league/.made ;
$(B)/gen/league/%.o: build/gen/league/%.c
	@mkdir -p $(@D)
	$(Q)$(CC) -std=gnu11 -w $(OPT) -fPIC -fvisibility=hidden $(SAN) -Ibuild/gen/league $(CPPFLAGS) $(CFLAGS) -c -o $@ $<
$(B)/src/league_net/messages.o: build/gen/league/.made
endif

# The page of `vsss view`.
FEATURE_EXCLUDE += $(call choose,CIVETWEB,src/view/web.c)
FEATURE_LIBS += $(if $(HAVE_CIVETWEB),-lcivetweb)

# The robots' firmware, which the rig runs; plain C that no other part of the program is in.
FEATURE_OBJ += $(B)/deploy/firmware/firmware.o

# AprilTag: the image and matrix helpers are in a second library that pkg-config does not name.
FEATURE_EXCLUDE += $(call choose,APRILTAG,src/vision/detect_tags.c)
FEATURE_LIBS += $(if $(HAVE_APRILTAG),-lapriltag -lapriltag-utils)

# libjpeg-turbo, else OpenCV decodes MJPG.
FEATURE_EXCLUDE += $(call choose,JPEG,src/vision/jpeg.c)
FEATURE_LIBS += $(if $(HAVE_JPEG),-ljpeg)

# EGL: the renderer opens the library when it draws, only the headers are needed here.
FEATURE_EXCLUDE += $(call choose,EGL,src/render/gl_context.c)

# ONNX Runtime: headers only; the library is opened when a model is (system package, or build/onnxruntime/lib).
FEATURE_EXCLUDE += $(call choose,ONNXRUNTIME,src/policy/policy_onnx.c)
FEATURE_CFLAGS += $(if $(HAVE_ONNXRUNTIME),-isystem $(firstword $(wildcard /usr/include/onnxruntime build/onnxruntime/include)))

# Modules: build/lib/vsss_NAME.so from the shims of one library, src/*/*_NAME.cpp (or .c). Never built with a sanitizer.
SHIM_CFLAGS := $(WARN) -O2 -g -fPIC -pthread -Iinclude -Isrc -MMD -MP $(CPPFLAGS)
SHIM_OBJ :=
# $(call module,NAME,SOURCES,INCLUDE FLAGS,LIBRARIES)
define module
MODULES += build/lib/vsss_$(1).so
SHIM_OBJ += $(2:%=build/shim/%.o)
$(2:%=build/shim/%.o): SHIM_INCLUDE := $(3)
build/lib/vsss_$(1).so: $(2:%=build/shim/%.o)
	@mkdir -p $$(@D)
	@echo '  LD    $$@'
	$$(Q)$$(CXX) $$(LDFLAGS) -shared -pthread -o $$@ $$^ $(4)
endef
build/shim/%.cpp.o: %.cpp build/features.mk
	@mkdir -p $(@D)
	@echo '  CXX   $<'
	$(Q)$(CXX) -std=gnu++17 $(SHIM_CFLAGS) $(CXXFLAGS) $(SHIM_INCLUDE) -c -o $@ $<
build/shim/%.c.o: %.c build/features.mk
	@mkdir -p $(@D)
	@echo '  CC    $<'
	$(Q)$(CC) -std=gnu11 $(SHIM_CFLAGS) $(CFLAGS) $(SHIM_INCLUDE) -c -o $@ $<

OPENCV_SHIMS := $(wildcard src/*/*_opencv.cpp)
TORCH_SHIMS := $(wildcard src/*/*_torch.cpp)
MPI_SHIMS := $(wildcard src/*/*_mpi.c)
FEATURE_EXCLUDE += $(MPI_SHIMS)
ifneq ($(HAVE_OPENCV),)
$(eval $(call module,opencv,$(OPENCV_SHIMS),-isystem /usr/include/opencv4,-lopencv_calib3d -lopencv_videoio -lopencv_imgcodecs -lopencv_imgproc -lopencv_core))
endif
ifneq ($(HAVE_TORCH),)
$(eval $(call module,torch,$(TORCH_SHIMS),-isystem /usr/include/torch/csrc/api/include,-ltorch -ltorch_cpu -lc10))
endif
ifneq ($(HAVE_MPI),)
$(eval $(call module,mpi,$(MPI_SHIMS),-isystem $(firstword $(wildcard /usr/lib/*/openmpi/include)),-lmpi))
endif
-include $(SHIM_OBJ:.o=.d)

features:
	@cat build/features.txt

# The learner's inner loops: vectorised, and free to fuse (nothing in them is simulation).
$(B)/src/learn/kernels.o: CFLAGS_ALL += -O3 -fopenmp-simd -ffp-contract=fast -fno-math-errno -fno-trapping-math

# A policy nobody trained, for tests and first tries.
EXTRA_ALL += build/untrained.onnx
build/untrained.onnx: $(if $(filter plain,$(FLAVOUR)),vsss,$(B)/vsss)
	@echo '  ONNX  $@'
	$(Q)./$< train --write-untrained $@
