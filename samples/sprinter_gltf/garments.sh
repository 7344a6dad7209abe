# Run by samples/run.sh in this folder. A sprinter's skirt ends above the knees: a folded knee would hold it.
"$make_garments" ../../../shared/assets/characters/quaternius_base_human/human-base-animations.glb --kind skirt --length 0.34 --rings 24 --out skirt.obj
