LEAK_SH += tests/whole/test_input.sh tests/whole/test_signals.sh tests/whole/test_lock.sh
ASAN_SH += tests/whole/test_same_hash.sh tests/whole/test_world.sh tests/whole/test_memory.sh tests/whole/test_contact.sh \
    tests/whole/test_intersections.sh tests/whole/test_options.sh tests/whole/test_live.sh tests/whole/test_simd.sh \
    tests/whole/test_images.sh tests/whole/test_system.sh tests/whole/test_welds.sh tests/whole/test_seams_tube.sh \
    tests/whole/test_bodies.sh tests/whole/test_contact_bodies.sh tests/whole/test_pins.sh tests/whole/test_pins_soft.sh tests/whole/test_follow.sh \
    tests/whole/test_scale.sh tests/whole/test_settled.sh tests/whole/test_sides.sh tests/whole/test_slope.sh tests/whole/test_untangle.sh \
    tests/whole/test_meshes.sh tests/whole/test_scenes.sh tests/whole/test_garment.sh tests/whole/test_mannequin.sh \
    tests/whole/test_hdf5.sh tests/whole/test_summary.sh
PLAIN_SH += tests/whole/test_dress.sh tests/whole/test_probes.sh tests/whole/test_pressure.sh tests/whole/test_sizes.sh tests/whole/test_colours.sh tests/whole/test_momentum.sh \
    tests/whole/test_predicted.sh tests/whole/test_capstan.sh tests/whole/test_contact_force.sh tests/whole/test_contact_laws.sh \
    tests/whole/test_policies.sh tests/whole/test_fabrics.sh tests/whole/test_cells.sh tests/whole/test_joints.sh \
    tests/whole/test_phases.sh tests/whole/test_timed_joints.sh tests/whole/test_joints_edges.sh tests/whole/test_folds.sh \
    tests/whole/test_seams.sh tests/whole/test_repulsion.sh tests/whole/test_correction.sh \
    tests/whole/test_integrators.sh tests/whole/test_materials.sh tests/whole/test_curves.sh tests/whole/test_groups.sh tests/whole/test_pinch.sh tests/whole/test_thickness.sh tests/whole/test_thicknesses.sh tests/whole/test_bad_input.sh \
    tests/whole/test_regions.sh tests/whole/test_closed_forms.sh tests/whole/test_checkpoint.sh tests/whole/test_dressing.sh tests/whole/test_export.sh tests/whole/test_check.sh \
    tests/whole/test_frame_range.sh tests/whole/test_pleats.sh
LONG_SH += tests/whole/test_same_hash_long.sh tests/whole/test_levels_long.sh tests/whole/test_demo.sh \
    tests/whole/test_stretch_limits_long.sh tests/whole/test_same_hash_models_long.sh tests/whole/test_same_hash_contact_long.sh \
    tests/whole/test_closed_forms_long.sh tests/whole/test_solvers_agree_long.sh tests/whole/test_contact_long.sh tests/whole/test_thicknesses_long.sh \
    tests/whole/test_capstan_long.sh tests/whole/test_pinch_long.sh tests/whole/test_contact_scenes_long.sh tests/whole/test_drape_long.sh \
    tests/whole/test_checkpoint_long.sh tests/whole/test_dressing_long.sh tests/whole/test_paraview_long.sh \
    tests/whole/test_blender_long.sh tests/whole/test_addon_long.sh tests/whole/test_gallery_long.sh
check_PROGRAMS += tests/whole/same_hash
tests_whole_same_hash_LDADD = $(CLOTH_LIBS)
if HAVE_ZMQ
check_PROGRAMS += tests/whole/spoil
tests_whole_spoil_SOURCES = tests/whole/spoil.c tests/fuzz/fit.h
tests_whole_spoil_LDADD = $(CLOTH_LIBS) $(XXHASH_LIBS)
check_PROGRAMS += tests/whole/live_peer
tests_whole_live_peer_LDADD = $(CLOTH_LIBS) $(ZMQ_LIBS) $(XXHASH_LIBS)
endif
check_PROGRAMS += tests/whole/metis_cuts
tests_whole_metis_cuts_LDADD = $(METIS_LIBS)
EXTRA_DIST += tests/whole/golden.sh tests/whole/golden.txt tests/whole/balance.awk tests/whole/spin.awk \
	tests/whole/joints.sh
EXTRA_DIST += tests/whole/garment_golden.txt
EXTRA_DIST += tests/whole/mannequin_golden.txt
EXTRA_DIST += tests/whole/dressing.sh tests/whole/garment.awk
EXTRA_DIST += tests/whole/read_back.sh tests/whole/read_back.py tests/whole/read_paraview.py tests/whole/read_blender.py tests/whole/read_export.py tests/whole/read_addon.py
