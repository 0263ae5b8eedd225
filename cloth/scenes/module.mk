dist_scenes_DATA += cloth/scenes/fabrics.yaml cloth/scenes/push.yaml cloth/scenes/sheet.yaml cloth/scenes/slope.yaml cloth/scenes/zara.yaml
