check_PROGRAMS += tests/whole/same_hash
tests_whole_same_hash_SOURCES = tests/whole/same_hash.c
tests_whole_same_hash_LDADD = $(CLOTH_LIBS)
dist_check_SCRIPTS += tests/whole/test_same_hash.sh tests/whole/test_same_hash_long.sh tests/whole/test_levels_long.sh tests/whole/test_dress.sh \
	tests/whole/test_demo.sh
TESTS += tests/whole/test_same_hash.sh tests/whole/test_dress.sh
LONG_TESTS += tests/whole/test_same_hash_long.sh tests/whole/test_levels_long.sh tests/whole/test_demo.sh
dist_check_SCRIPTS += tests/whole/test_probes.sh
dist_check_SCRIPTS += tests/whole/test_world.sh
dist_check_SCRIPTS += tests/whole/test_colours.sh
TESTS += tests/whole/test_colours.sh
TESTS += tests/whole/test_probes.sh tests/whole/test_world.sh
dist_check_SCRIPTS += tests/whole/test_momentum.sh
TESTS += tests/whole/test_momentum.sh
dist_check_SCRIPTS += tests/whole/test_memory.sh tests/whole/test_predicted.sh
TESTS += tests/whole/test_memory.sh tests/whole/test_predicted.sh
dist_check_SCRIPTS += tests/whole/test_capstan.sh tests/whole/test_contact.sh tests/whole/test_contact_force.sh \
	tests/whole/test_contact_laws.sh tests/whole/test_input.sh tests/whole/test_intersections.sh tests/whole/test_options.sh
TESTS += tests/whole/test_capstan.sh tests/whole/test_contact.sh tests/whole/test_contact_force.sh tests/whole/test_contact_laws.sh \
	tests/whole/test_input.sh tests/whole/test_intersections.sh tests/whole/test_options.sh
dist_check_SCRIPTS += tests/whole/test_policies.sh
TESTS += tests/whole/test_policies.sh
dist_check_SCRIPTS += tests/whole/test_live.sh
TESTS += tests/whole/test_live.sh
if HAVE_ZMQ
check_PROGRAMS += tests/whole/spoil
tests_whole_spoil_SOURCES = tests/whole/spoil.c tests/fuzz/fit.h
tests_whole_spoil_LDADD = $(CLOTH_LIBS) $(XXHASH_LIBS)
check_PROGRAMS += tests/whole/live_peer
tests_whole_live_peer_SOURCES = tests/whole/live_peer.c
tests_whole_live_peer_LDADD = $(CLOTH_LIBS) $(ZMQ_LIBS) $(XXHASH_LIBS)
endif
dist_check_SCRIPTS += tests/whole/test_signals.sh tests/whole/test_lock.sh
TESTS += tests/whole/test_signals.sh tests/whole/test_lock.sh
dist_check_SCRIPTS += tests/whole/test_simd.sh
TESTS += tests/whole/test_simd.sh
dist_check_SCRIPTS += tests/whole/test_images.sh
TESTS += tests/whole/test_images.sh
dist_check_SCRIPTS += tests/whole/test_system.sh
TESTS += tests/whole/test_system.sh
dist_check_SCRIPTS += tests/whole/test_fabrics.sh tests/whole/test_cells.sh
TESTS += tests/whole/test_fabrics.sh tests/whole/test_cells.sh
dist_check_SCRIPTS += tests/whole/test_joints.sh tests/whole/test_phases.sh tests/whole/test_timed_joints.sh \
	tests/whole/test_joints_edges.sh tests/whole/test_folds.sh tests/whole/test_welds.sh tests/whole/test_seams.sh \
	tests/whole/test_seams_tube.sh
TESTS += tests/whole/test_joints.sh tests/whole/test_phases.sh tests/whole/test_timed_joints.sh tests/whole/test_joints_edges.sh \
	tests/whole/test_folds.sh tests/whole/test_welds.sh tests/whole/test_seams.sh tests/whole/test_seams_tube.sh
dist_check_SCRIPTS += tests/whole/test_bodies.sh tests/whole/test_contact_bodies.sh tests/whole/test_contact_scenes.sh \
	tests/whole/test_pins.sh tests/whole/test_follow.sh tests/whole/test_settled.sh tests/whole/test_sides.sh \
	tests/whole/test_slope.sh
TESTS += tests/whole/test_bodies.sh tests/whole/test_contact_bodies.sh tests/whole/test_contact_scenes.sh tests/whole/test_pins.sh \
	tests/whole/test_follow.sh tests/whole/test_settled.sh tests/whole/test_sides.sh tests/whole/test_slope.sh
dist_check_SCRIPTS += tests/whole/test_repulsion.sh
TESTS += tests/whole/test_repulsion.sh
dist_check_SCRIPTS += tests/whole/test_correction.sh
TESTS += tests/whole/test_correction.sh
dist_check_SCRIPTS += tests/whole/test_untangle.sh
TESTS += tests/whole/test_untangle.sh
dist_check_SCRIPTS += tests/whole/test_integrators.sh
TESTS += tests/whole/test_integrators.sh
dist_check_SCRIPTS += tests/whole/test_materials.sh
TESTS += tests/whole/test_materials.sh
dist_check_SCRIPTS += tests/whole/test_curves.sh tests/whole/test_groups.sh tests/whole/test_meshes.sh tests/whole/test_regions.sh
TESTS += tests/whole/test_curves.sh tests/whole/test_groups.sh tests/whole/test_meshes.sh tests/whole/test_regions.sh
dist_check_SCRIPTS += tests/whole/test_closed_forms.sh
TESTS += tests/whole/test_closed_forms.sh
dist_check_SCRIPTS += tests/whole/test_stretch_limits_long.sh
LONG_TESTS += tests/whole/test_stretch_limits_long.sh
dist_check_SCRIPTS += tests/whole/test_same_hash_models_long.sh
LONG_TESTS += tests/whole/test_same_hash_models_long.sh
dist_check_SCRIPTS += tests/whole/test_same_hash_contact_long.sh
LONG_TESTS += tests/whole/test_same_hash_contact_long.sh
dist_check_SCRIPTS += tests/whole/test_closed_forms_long.sh
LONG_TESTS += tests/whole/test_closed_forms_long.sh
dist_check_SCRIPTS += tests/whole/test_solvers_agree_long.sh
LONG_TESTS += tests/whole/test_solvers_agree_long.sh
check_PROGRAMS += tests/whole/metis_cuts
tests_whole_metis_cuts_SOURCES = tests/whole/metis_cuts.c
tests_whole_metis_cuts_LDADD = $(METIS_LIBS)
dist_check_SCRIPTS += tests/whole/test_golden.sh
EXTRA_DIST += tests/whole/golden.txt tests/whole/balance.awk tests/whole/spin.awk \
	tests/whole/joints.sh
TESTS += tests/whole/test_golden.sh
dist_check_SCRIPTS += tests/whole/test_contact_long.sh tests/whole/test_capstan_long.sh
LONG_TESTS += tests/whole/test_contact_long.sh tests/whole/test_capstan_long.sh
dist_check_SCRIPTS += tests/whole/test_contact_scenes_long.sh tests/whole/test_drape_long.sh
LONG_TESTS += tests/whole/test_contact_scenes_long.sh tests/whole/test_drape_long.sh
dist_check_SCRIPTS += tests/whole/test_garment.sh
EXTRA_DIST += tests/whole/garment_golden.txt
TESTS += tests/whole/test_garment.sh
dist_check_SCRIPTS += tests/whole/test_mannequin.sh
EXTRA_DIST += tests/whole/mannequin_golden.txt
TESTS += tests/whole/test_mannequin.sh
dist_check_SCRIPTS += tests/whole/test_checkpoint.sh tests/whole/test_checkpoint_long.sh
TESTS += tests/whole/test_checkpoint.sh
LONG_TESTS += tests/whole/test_checkpoint_long.sh
dist_check_SCRIPTS += tests/whole/test_hdf5.sh
TESTS += tests/whole/test_hdf5.sh
dist_check_SCRIPTS += tests/whole/test_dressing.sh tests/whole/test_dressing_long.sh
EXTRA_DIST += tests/whole/dressing.sh tests/whole/garment.awk
TESTS += tests/whole/test_dressing.sh
LONG_TESTS += tests/whole/test_dressing_long.sh
dist_check_SCRIPTS += tests/whole/test_summary.sh
TESTS += tests/whole/test_summary.sh
dist_check_SCRIPTS += tests/whole/test_paraview_long.sh tests/whole/test_blender_long.sh
EXTRA_DIST += tests/whole/read_back.sh tests/whole/read_back.py tests/whole/read_paraview.py tests/whole/read_blender.py
LONG_TESTS += tests/whole/test_paraview_long.sh tests/whole/test_blender_long.sh
