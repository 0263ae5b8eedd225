dist_scenes_DATA += cloth/scenes/drape.yaml cloth/scenes/dressing.yaml cloth/scenes/fabrics.yaml cloth/scenes/jeans.yaml \
	cloth/scenes/laid.yaml cloth/scenes/layers.yaml cloth/scenes/push.yaml cloth/scenes/sheet.yaml cloth/scenes/shirt.yaml cloth/scenes/slope.yaml \
	cloth/scenes/sphere.yaml cloth/scenes/stack.yaml cloth/scenes/twist.yaml cloth/scenes/walk.yaml cloth/scenes/zara.yaml
gallerydir = $(scenesdir)/gallery
dist_gallery_DATA = cloth/scenes/gallery/cape.yaml cloth/scenes/gallery/clothesline.yaml cloth/scenes/gallery/curtain.yaml \
	cloth/scenes/gallery/cushion.yaml cloth/scenes/gallery/drape.yaml cloth/scenes/gallery/flag.yaml \
	cloth/scenes/gallery/hammock.yaml cloth/scenes/gallery/leaves.yaml cloth/scenes/gallery/parachute.yaml \
	cloth/scenes/gallery/fabrics.yaml cloth/scenes/gallery/pleats.yaml cloth/scenes/gallery/pulled.yaml \
	cloth/scenes/gallery/ribbon.yaml cloth/scenes/gallery/sail.yaml cloth/scenes/gallery/skirt.yaml \
	cloth/scenes/gallery/slope.yaml cloth/scenes/gallery/stack.yaml cloth/scenes/gallery/stairs.yaml \
	cloth/scenes/gallery/studio.yaml cloth/scenes/gallery/tablecloth.yaml cloth/scenes/gallery/twist.yaml
