"""What do coupled oscillators make of a single drive: walking, swimming, turning, order from any start?"""
