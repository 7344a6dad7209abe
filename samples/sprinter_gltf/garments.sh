# Run by samples/run.sh in this folder.
"$make_garments" ../../../shared/assets/characters/quaternius_base_human/human-base-animations.glb --kind skirt --out skirt.obj
