// Moves: spheres,lights
// The first sphere bounces, as high as it is wide, and the first lamp goes round it.
bool animate(uint32_t frame, uint32_t frames)
{
    using scene::Number;
    const auto& ball = scene::first_spheres[0];
    const auto width = scene::frame.back(Number::coarse(ball.radius + ball.radius, ball.fine));
    // 4 t (1 - t), a parabola from 0 to 1 and back
    const auto share = qray::coordinate<Number>(static_cast<int32_t>(4 * frame * (frames - frame)),
                                                static_cast<int32_t>(frames * frames));
    qray::Motion<Number> up(scene::frame), round(scene::frame);
    up.shift({{}, qray::times<Number>(width, share), {}});
    const uint32_t angle = qray::part_of_turn(frame, frames);
    round.about(scene::frame.place(ball.centre)).turn({{}, qray::coordinate<Number>(1), {}}, angle);
    const bool moved = move(ball, up, scene::spheres[0]) && move(scene::first_lights[0], round, scene::lights[0]);
    scene::refit();
    return moved;
}
