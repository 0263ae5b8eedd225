dist_scenes_DATA += cloth/scenes/sheet.yaml cloth/scenes/zara.yaml
