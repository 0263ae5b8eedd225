dist_scenes_DATA += cloth/scenes/drape.yaml cloth/scenes/dressing.yaml cloth/scenes/fabrics.yaml cloth/scenes/jeans.yaml \
	cloth/scenes/layers.yaml cloth/scenes/push.yaml cloth/scenes/sheet.yaml cloth/scenes/shirt.yaml cloth/scenes/slope.yaml \
	cloth/scenes/sphere.yaml cloth/scenes/stack.yaml cloth/scenes/twist.yaml cloth/scenes/walk.yaml cloth/scenes/zara.yaml
