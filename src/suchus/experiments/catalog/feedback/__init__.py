"""Do three feedback rules coordinate limbs, spine and tail, and what do they help against?"""
